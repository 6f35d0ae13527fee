#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/machine_file.h"
#include "cli/wheel.h"
#include "cli/zeros.h"

#include <memory>

namespace grinder {

namespace {

void addWheel(Commands& commands) {
  const auto options = std::make_shared<WheelOptions>();
  auto& wheel = commands.add("wheel", "show a wheel file, or write into it what the wheel has become",
                             "show wheels/straight_d125_w2.yaml", nullptr);
  const auto add = [&](const char* name, const char* description, const std::string& example,
                       int (*action)(const WheelOptions&)) -> CLI::App& {
    auto& command = commands.addTo(wheel, name, description, example, [options, action] { return action(*options); });
    command.add_option("FILE", options->file, "wheel file (YAML, mm, deg)")->required()->type_name(kYamlFile);
    return command;
  };
  addJson(add("show", "print the wheel as it is now", "wheels/straight_d125_w2.yaml", showWheel), options->json);
  auto& measure =
      add("measure", "write a measurement into the file", "wheels/my_wheel.yaml --diameter 99.62", measureWheel);
  addLength(measure, "--diameter", options->diameter_mm, "maximum diameter as measured", false).required();
  addLength(measure, "--width", options->width_mm, "width as measured (default: as before)", false);
  measure.add_flag("--force", options->force, "the wheel may be larger than the file says, which was wrong");
  auto& dress =
      add("dress", "write into the file what the wheel has lost", "wheels/my_wheel.yaml --radial 0.02", dressWheel);
  addLength(dress, "--radial", options->radial_mm, "taken off the radius", true);
  addLength(dress, "--face", options->face_mm, "taken off the width", true);
}

void addZeros(Commands& commands) {
  const auto options = std::make_shared<ZerosOptions>();
  const Action set = commands.online([&commands, options] { return setZeros(commands.node, *options); });
  auto& command = commands.add("zeros", "compute where the job's X, Y and Z are zero, in machine coordinates",
                               "jobs/unequal_d12_t4.yaml --stickout 62",
                               [options, set] { return options->set ? set() : printZeros(*options); });
  addJob(command, options->job);
  addOperation(command, options->operation);
  addLength(command, "--stickout", options->stickout_mm, "from the collet's face to the cutter's small end", false)
      .required();
  addFlange(command, options->flange_mm);
  auto* set_flag = command.add_flag("--set", options->set,
                                    "by the geometry of the running grinder, and set them as its work offsets");
  addMachine(command, options->parameters, options->urdf);
  // --set uses the geometry of the running machine.
  for (const char* file : {"--machine", "--urdf"}) set_flag->excludes(command.get_option(file));
  addAnswer(command, options->answers, {NeedAnswer::kSetOffset})->needs(set_flag);
  addJson(command, options->json);
}

void addMachineFile(Commands& commands) {
  const auto options = std::make_shared<MachineOptions>();
  auto& command =
      commands.add("machine", "check the machine's files as the launch file does before it starts the grinder",
                   "config/grinder.yaml --urdf urdf/grinder.urdf", [options] { return runMachine(*options); });
  command
      .add_option("FILE", options->parameters, "parameters of the machine; those of a file override those before it")
      ->required()
      ->type_name(kYamlFile);
  command.add_option("--urdf", options->urdf, "robot description")->required()->type_name(kUrdfFile);
  command.add_option("--bag", options->bag, "bag that the launch is to have written: refused if it is there already")
      ->type_name(kAnyFile);
}

}  // namespace

void addWheelCommands(Commands& commands) {
  addWheel(commands);
  addZeros(commands);
  addMachineFile(commands);
}

}  // namespace grinder
