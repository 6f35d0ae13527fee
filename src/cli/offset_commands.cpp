#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/offsets.h"
#include "cli/probe.h"

#include <memory>

namespace flute_grinder {

namespace {

void addOffsets(Commands& commands) {
  const auto options = std::make_shared<OffsetsOptions>();
  auto& command = commands.add(
      "offsets", "print the work offsets, with who set them and when, and the positions of the axes; or set them",
      "--set y=45.2 --job jobs/paper.yaml",
      Commands::online([&commands, options] { return runOffsets(commands.node, *options); }));
  command.add_option("--set", options->set, "set the offset of an axis, in mm or deg")
      ->type_name("AXIS=VALUE")
      ->check(offsetRefusal);
  command.add_option("--job", options->job, "with --set: job for which it is set; y and z need it")
      ->type_name(kYamlFile);
  command
      .add_option("--fit", options->fit,
                  "fit Y and Z to this job, of the same wheel and swivel as the job for which they were set")
      ->type_name(kYamlFile);
  addYes(command, options->yes);
  addJson(command, options->json);
}

void addTouchOff(Commands& commands) {
  const auto options = std::make_shared<TouchOffOptions>();
  auto& command = commands.add("touch-off", "set the work offset of an axis from where it stands now",
                               "y --at 12.02 --job jobs/paper.yaml",
                               Commands::online([&commands, options] { return runTouchOff(commands.node, *options); }));
  addAxis(command, options->axis);
  command
      .add_option(
          "--at", options->at,
          "y: diameter of the blank that the wheel touches; x, z, a: work position here (default: 0); mm or deg")
      ->check([](const std::string& text) {
        return std::isfinite(std::strtod(text.c_str(), nullptr)) ? "" : text + "; allowed: a finite number";
      });
  command.add_option("--job", options->job, "job to be ground; y and z need it")->type_name(kYamlFile);
  addYes(command, options->yes);
}

void addProbe(Commands& commands) {
  const auto options = std::make_shared<ProbeOptions>();
  auto& probe = commands.add("probe", "measure with the measuring probe, jogged near; Ctrl-C and Ctrl-Z stop it",
                             "end-face --job jobs/unequal_d12_t4.yaml", nullptr);
  const auto add = [&](const char* name, const char* description, const std::string& example,
                       int (*action)(const std::string&, const ProbeOptions&)) -> CLI::App* {
    const auto carry_out = [&commands, options, action] { return action(commands.node, *options); };
    return &commands.addTo(probe, name, description, example, Commands::online(carry_out));
  };
  CLI::App* face =
      add("end-face", "X: print the stick-out and set the work offset", "--job jobs/unequal_d12_t4.yaml", probeEndFace);
  CLI::App* diameter =
      add("diameter", "Y, on four sides: print diameter and run-out of a cylinder", "--within 2", probeDiameter);
  CLI::App* tooth = add("tooth", "A: touch the first tooth's rake face and set the work offset",
                        "--job jobs/unequal_d12_t4.yaml", probeTooth);
  for (CLI::App* command : {face, tooth}) {
    command->add_option("--job", options->job, "job to be ground")->required()->type_name(kYamlFile);
    addFlange(*command, options->flange_mm);
  }
  for (CLI::App* command : {face, diameter}) {
    addLength(*command, "--within", options->within_mm, "the farthest way to the touch", false).capture_default_str();
  }
  tooth->add_option("--within", options->within_deg, "the farthest turn to the touch")
      ->type_name("DEG")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 360.0));
  addLength(*diameter, "--at", options->at_mm, "sets the work offset of Y so that the diameter is this one", false);
  diameter->add_option("--job", options->job, "with --at: job to be ground")->type_name(kYamlFile);
}

}  // namespace

void addOffsetCommands(Commands& commands) {
  addOffsets(commands);
  addTouchOff(commands);
  addProbe(commands);
}

}  // namespace flute_grinder
