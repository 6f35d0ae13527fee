#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/offsets.h"
#include "cli/probe.h"
#include "flute_grinder/base/quantity.h"

#include <algorithm>
#include <memory>

namespace grinder {

namespace {

void addOffsets(Commands& commands) {
  const auto options = std::make_shared<OffsetsOptions>();
  auto& command = commands.add(
      "offsets", "print the work offsets, with who set them and when, and the positions of the axes; or set them",
      "--set y=45.2 --job jobs/paper.yaml",
      commands.online([&commands, options] { return runOffsets(commands.node, *options); }));
  command.add_option("--set", options->set, "set the offset of an axis, in mm or deg")
      ->type_name("AXIS=VALUE")
      ->check(offsetRefusal);
  command.add_option("--job", options->job, "with --set: job for which it is set; y and z need it")
      ->type_name(kYamlFile);
  addOperation(command, options->operation);
  addAnswer(command, options->answers, {NeedAnswer::kSetOffset});
  addJson(command, options->json);
}

void addTouchOff(Commands& commands) {
  const auto options = std::make_shared<TouchOffOptions>();
  auto& command = commands.add("touch-off", "set the work offset of an axis from where it is now",
                               "y --at 12.02 --job jobs/paper.yaml",
                               commands.online([&commands, options] { return runTouchOff(commands.node, *options); }));
  addAxis(command, options->axis);
  command
      .add_option(
          "--at", options->at,
          "y: diameter of the blank that the wheel touches; x, z, a: work position here (default: 0); mm or deg")
      ->check([](const std::string& text) {
        return std::isfinite(parseNumber(text.c_str())) ? "" : text + "; allowed: a finite number";
      });
  command.add_option("--job", options->job, "job to be ground; y and z need it")->type_name(kYamlFile);
  addOperation(command, options->operation);
  addAnswer(command, options->answers, {NeedAnswer::kSetOffset});
}

void addConfirmWheel(Commands& commands) {
  const auto options = std::make_shared<ConfirmWheelOptions>();
  auto& command = commands.add("confirm-wheel", "confirm that the wheel of a job is on the spindle", "jobs/paper.yaml",
                               commands.online([&commands, options] { return confirmWheel(commands.node, *options); }));
  addJob(command, options->job);
  addOperation(command, options->operation);
  command.add_flag("--again", options->again,
                   "it was taken off and mounted anew: zero points of X, Y and Z do not count any longer");
}

void addReclamped(Commands& commands) {
  commands.add("reclamped", "say that a tool was clamped: where its teeth are is then not known", "",
               commands.online([&commands] { return sayReclamped(commands.node); }));
}

void addCycle(Commands& commands, CLI::App& probe, const ProbingCycleRow& row) {
  const auto options = std::make_shared<ProbeOptions>();
  options->within = row.within / shopScale(unitOf(row.axis, 0));
  std::string name = row.name;
  std::replace(name.begin(), name.end(), '_', '-');
  auto& command = commands.addTo(
      probe, name, row.help, row.always_for_job ? "--job jobs/unequal_d12_t4.yaml" : "--within 2",
      commands.online([&commands, options, cycle = row.value] { return runProbe(commands.node, cycle, *options); }));
  if (row.axis == kA) {
    command.add_option("--within", options->within, "the farthest turn to the touch")
        ->type_name("DEG")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 360.0));
  } else {
    addLength(command, "--within", options->within, "the farthest way to the touch", false).capture_default_str();
  }
  if (row.always_for_job) {
    command.add_option("--job", options->job, "job to be ground")->required()->type_name(kYamlFile);
    addFlange(command, options->flange_mm);
  } else {
    addLength(command, "--at", options->at_mm, "sets the work offset of Y so that the diameter is this one", false);
    command.add_option("--job", options->job, "with --at: job to be ground")->type_name(kYamlFile);
  }
  addOperation(command, options->operation);
  addAnswer(command, options->answers, {NeedAnswer::kSetOffset});
}

void addProbe(Commands& commands) {
  auto& probe = commands.add("probe", "measure with the measuring probe, jogged near; Ctrl-C and Ctrl-Z stop it",
                             "end-face --job jobs/unequal_d12_t4.yaml", nullptr);
  for (const ProbingCycleRow& row : kProbingCycles) addCycle(commands, probe, row);
}

}  // namespace

void addOffsetCommands(Commands& commands) {
  addConfirmWheel(commands);
  addReclamped(commands);
  addOffsets(commands);
  addTouchOff(commands);
  addProbe(commands);
}

}  // namespace grinder
