#include "flute_grinder/cli/completion.h"
#include "flute_grinder/cli/history.h"
#include "flute_grinder/cli/offline.h"
#include "flute_grinder/cli/offsets.h"
#include "flute_grinder/cli/online.h"
#include "flute_grinder/cli/probe.h"
#include "flute_grinder/cli/report.h"
#include "flute_grinder/cli/setup.h"
#include "flute_grinder/cli/simulate.h"
#include "flute_grinder/cli/state_watch.h"
#include "flute_grinder/cli/wheel.h"
#include "flute_grinder/cli/zeros.h"
#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/core/feed_schedule.h"
#include "flute_grinder/core/job_file.h"

#include <ros/package.h>
#include <ros/ros.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>

namespace {

using namespace flute_grinder;

constexpr int kUsage = 2;  ///< exit status for wrong usage and unreadable files

/// @param example realistic arguments.
CLI::App& addCommand(CLI::App& app, const std::string& name, const std::string& description,
                     const std::string& example = "") {
  return *app.add_subcommand(name, description)
              ->footer("Example:\n  rosrun flute_grinder grind " + name + (example.empty() ? "" : " ") + example);
}

void addJob(CLI::App& command, std::string& job) {
  command.add_option("JOB", job, "job file (YAML, mm, deg, mm/min)")->required()->type_name(kYamlFile);
}

void addCsv(CLI::App& command, std::string& csv, const char* description) {
  command.add_option("--csv", csv, description)->type_name(kAnyFile);
}

void addJson(CLI::App& command, bool& json) { command.add_flag("--json", json, "print only JSON"); }

/// @param name of the option.
void addCountedJob(CLI::App& command, const char* name, int& number) {
  command.add_option(name, number, "which of a bag's jobs, counted from 1 (default: the last)")
      ->check([](const std::string& text) {
        return std::strtol(text.c_str(), nullptr, 10) >= 1 ? "" : text + "; allowed: 1 or more";
      });
}

/// An option whose argument is the name of an enum's value.
template <typename Enum>
void addChoice(CLI::App& command, const char* name, std::optional<Enum>& choice, const char* description) {
  std::map<std::string, Enum> values;
  std::string names;
  for (const auto& row : rowsOf(Enum{})) {
    values[row.name] = row.value;
    names += (names.empty() ? "" : "|") + std::string(row.name);
  }
  command
      .add_option_function<Enum>(
          name, [&choice](const Enum& value) { choice = value; }, description)
      ->transform(CLI::CheckedTransformer(values).description(""))
      ->type_name("{" + names + "}");
}

void addTable(CLI::App& app, TableOptions& options) {
  auto& command =
      addCommand(app, "table", "interpolate the job's curve with a fixed step length, as in the paper's Table 1",
                 "jobs/paper.yaml --step-length 0.2 --even-step exact");
  addJob(command, options.job);
  command.add_option("--step-length", options.step_length_mm, "step length in mm; A is weighted by rotary_scale")
      ->required()
      ->check([](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return value >= 1e-4 && value <= 100 ? "" : text + "; allowed: 0.0001 to 100 mm";
      });
  addChoice(command, "--even-step", options.even_step, "instead of the job's rule");
  addCsv(command, options.csv, "write the points to this file");
  addJson(command, options.json);
}

/// The files that describe the machine; by default the package's own.
void addMachine(CLI::App& command, std::string& parameters, std::string& urdf) {
  command.add_option("--machine", parameters, "parameters of the machine (default: config/grinder.yaml)")
      ->type_name(kYamlFile);
  command.add_option("--urdf", urdf, "robot description (default: urdf/grinder.urdf)")->type_name(kUrdfFile);
  command.final_callback([&parameters, &urdf] {
    const std::string package = ros::package::getPath("flute_grinder");
    if (parameters.empty()) parameters = package + "/config/grinder.yaml";
    if (urdf.empty()) urdf = package + "/urdf/grinder.urdf";
  });
}

void addPlan(CLI::App& app, PlanOptions& options) {
  auto& command = addCommand(app, "plan", "generate and check every setpoint of the job, from the park position",
                             "jobs/paper.yaml --csv setpoints.csv");
  addJob(command, options.job);
  addCsv(command, options.csv, "write the setpoints to this file");
  addMachine(command, options.parameters, options.urdf);
  addJson(command, options.json);
}

void addSimulate(CLI::App& app, SimulateOptions& options) {
  auto& command = addCommand(app, "simulate", "compute and measure the cutter that a job grinds or a run has ground",
                             "jobs/paper.yaml --at 1,17,29");
  command.add_option("FILE", options.file, "job file, CSV file of run, or a bag of 'roslaunch ... record:=true'")
      ->required()
      ->type_name(kAnyFile);
  auto* at = command.add_option("--at", options.at_mm, "X of the sections in mm, separated by commas")->delimiter(',');
  at->type_name("MM,MM,...");
  command.add_option("--sections", options.sections, "number of sections over the flute's length (default: 9)")
      ->excludes(at)
      ->check([](const std::string& text) {
        const long value = std::strtol(text.c_str(), nullptr, 10);
        return value >= 2 && value <= kMostSections ? "" : text + "; allowed: 2 to " + std::to_string(kMostSections);
      });
  addCsv(command, options.csv, "write the figures of every section and tooth to this file");
  command.add_option("--stl", options.stl, "write the cutter as a solid to this file, in mm")->type_name(kAnyFile);
  command.add_option("--svg", options.svg, "draw the sections at both ends and in the middle, and the figures over X")
      ->type_name(kAnyFile);
  command.add_option("--job", options.job, "job file of a record that does not have its job")->type_name(kYamlFile);
  addCountedJob(command, "--run", options.run);
  addJson(command, options.json);
}

void addSetup(CLI::App& app, SetupOptions& options) {
  auto& command = addCommand(app, "setup", "solve swivel, height and depth of the wheel for the job's rake and core",
                             "jobs/paper.yaml --write");
  addJob(command, options.job);
  addChoice(command, "--keep", options.keep, "leave this figure as it is in the job file");
  command.add_flag("--write", options.write, "write the set-up into the job file; all else in it stays as it is");
  addMachine(command, options.parameters, options.urdf);
  addJson(command, options.json);
}

void addRun(CLI::App& app, RunOptions& options) {
  auto& command =
      addCommand(app, "run", "grind the job; Ctrl-C cancels it and waits until it has ended, Ctrl-Z holds it",
                 "jobs/paper.yaml --csv streamed.csv");
  addJob(command, options.job);
  command.add_flag("--dry-run", options.dry_run, "plan, check and show the path, but move nothing");
  auto* go_on =
      command.add_flag("--continue", options.go_on, "continue at the first unfinished pass in the grinder's journal");
  command
      .add_flag("--discard", options.discard,
                "start even if the grinder's journal holds another, unfinished job, and discard that job")
      ->excludes(go_on);
  addCsv(command, options.csv, "write the streamed setpoints to this file");
}

void addOverride(CLI::App& app, double& percent) {
  auto& command = addCommand(app, "override", "set the feed override; 0 stops the feed, rapids keep their speed", "50");
  command.add_option("PERCENT", percent, "of the job's feed, 0 to 120")->required()->check([](const std::string& text) {
    const double value = std::strtod(text.c_str(), nullptr);
    return value >= 0 && value <= kMaxFeedOverride * 100 ? "" : text + "; allowed: 0 to 120 %";
  });
}

void addConfirmSwivel(CLI::App& app, double& degrees) {
  auto& command = addCommand(app, "confirm-swivel",
                             "tell the grinder at which angle the swivel has been set and clamped by hand", "31.769");
  command.add_option("DEG", degrees, "as setup.swivel_deg of the job, -90 to 90")
      ->required()
      ->check([](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return std::abs(value) <= 90 ? "" : text + "; allowed: -90 to 90 deg";
      });
}

void addOffsets(CLI::App& app, OffsetsOptions& options) {
  auto& command =
      addCommand(app, "offsets",
                 "print the work offsets, with who set them and when, and the positions of the axes; or set "
                 "them",
                 "--set y=45.2");
  command.add_option("--set", options.set, "set the offset of an axis, in mm or deg")
      ->type_name("AXIS=VALUE")
      ->check(offsetRefusal);
  addJson(command, options.json);
}

void addAxis(CLI::App& command, std::string& axis) {
  std::vector<std::string> axes;
  std::string names;
  for (const char* letter = kAxisLetters; *letter != '\0'; ++letter) {
    axes.emplace_back(1, *letter);
    names += (names.empty() ? "" : "|") + axes.back();
  }
  command.add_option("AXIS", axis, "which axis")
      ->required()
      ->check(CLI::IsMember(axes).description(""))
      ->type_name("{" + names + "}");
}

void addTouchOff(CLI::App& app, TouchOffOptions& options) {
  auto& command = addCommand(app, "touch-off", "set the work offset of an axis from where it stands now",
                             "y --at 12.02 --job jobs/paper.yaml");
  addAxis(command, options.axis);
  command
      .add_option(
          "--at", options.at,
          "y: diameter of the blank that the wheel touches; x, z, a: work position here (default: 0); mm or deg")
      ->check([](const std::string& text) {
        return std::isfinite(std::strtod(text.c_str(), nullptr)) ? "" : text + "; allowed: a finite number";
      });
  command.add_option("--job", options.job, "y: job to be ground")->type_name(kYamlFile);
}

/// Arguments of `grind jog`.
struct JogOptions {
  std::string axis;
  double distance = 0;
  double feed = 0;
};

void addJog(CLI::App& app, JogOptions& options) {
  auto& command = addCommand(app, "jog", "move an axis by hand; waits until it rests, and Ctrl-C and Ctrl-Z stop it",
                             "y 0.5 --feed 100");
  addAxis(command, options.axis);
  command.add_option("DISTANCE", options.distance, "in mm, of A in deg; negative in the other direction")->required();
  command.add_option("--feed", options.feed, "in mm/min, of A in deg/min (default: parameter jog_velocity)")
      ->check([](const std::string& text) {
        return std::strtod(text.c_str(), nullptr) > 0 ? "" : text + "; allowed: above 0";
      });
}

void addReport(CLI::App& app, ReportOptions& options) {
  auto& command = addCommand(app, "report", "draw a table, a plan or a recorded run as an HTML file",
                             "setpoints.csv -o report.html");
  command.add_option("FILE", options.file, "CSV file of table, plan or run, or a bag of 'roslaunch ... record:=true'")
      ->required()
      ->type_name(kAnyFile);
  command.add_option("-o,--output", options.output, "HTML file to write")->required()->type_name(kAnyFile);
  addCountedJob(command, "--job", options.job);
  addMachine(command, options.parameters, options.urdf);
}

void addHistory(CLI::App& app, HistoryOptions& options) {
  auto& command = addCommand(app, "history", "list the records of the grinder's last jobs, the newest last");
  command.add_option("--folder", options.folder, "folder of the records (default: the grinder's below ~/.ros)")
      ->type_name(kFolder);
  addJson(command, options.json);
}

/// A length in mm that may be as small as `least`.
template <typename Length>
CLI::Option& addLength(CLI::App& command, const char* name, Length& length_mm, const char* description, bool zero) {
  return *command.add_option(name, length_mm, description)->type_name("MM")->check([zero](const std::string& text) {
    const double value = std::strtod(text.c_str(), nullptr);
    const bool good = std::isfinite(value) && (zero ? value >= 0 : value > 0);
    return good ? "" : text + "; allowed: " + (zero ? "0 mm or more" : "more than 0 mm");
  });
}

void addWheel(CLI::App& app, WheelOptions& options) {
  auto& wheel = addCommand(app, "wheel", "show a wheel file, or write into it what the wheel has become",
                           "show wheels/straight_d125_w2.yaml");
  wheel.require_subcommand(1);
  const auto add = [&](const char* name, const char* description, const std::string& arguments) -> CLI::App& {
    auto* command = wheel.add_subcommand(name, description);
    command->footer(std::string("Example:\n  rosrun flute_grinder grind wheel ") + name + " " + arguments);
    command->add_option("FILE", options.file, "wheel file (YAML, mm, deg)")->required()->type_name(kYamlFile);
    return *command;
  };
  addJson(add("show", "print the wheel as it is now", "wheels/straight_d125_w2.yaml"), options.json);
  auto& measure = add("measure", "write a measurement into the file", "wheels/my_wheel.yaml --diameter 99.62");
  addLength(measure, "--diameter", options.diameter_mm, "largest diameter as measured", false).required();
  addLength(measure, "--width", options.width_mm, "width as measured (default: as before)", false);
  measure.add_flag("--force", options.force, "the wheel may be larger than the file says, which was wrong");
  auto& dress = add("dress", "write into the file what the wheel has lost", "wheels/my_wheel.yaml --radial 0.02");
  addLength(dress, "--radial", options.radial_mm, "taken off the radius", true);
  addLength(dress, "--face", options.face_mm, "taken off the width", true);
}

void addFlange(CLI::App& command, std::optional<double>& flange_mm) {
  command
      .add_option("--flange", flange_mm, "from the flange's face to the wheel's upper face (default: the wheel file's)")
      ->type_name("MM")
      ->check([](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return value >= -100 && value <= 100 ? "" : text + "; allowed: -100 to 100 mm";
      });
}

void addProbe(CLI::App& app, ProbeOptions& options) {
  auto& probe = addCommand(app, "probe", "measure with the measuring probe, jogged near; Ctrl-C and Ctrl-Z stop it",
                           "end-face --job jobs/unequal_d12_t4.yaml");
  probe.require_subcommand(1);
  const auto add = [&](const char* name, const char* description, const std::string& arguments) -> CLI::App& {
    auto* command = probe.add_subcommand(name, description);
    command->footer(std::string("Example:\n  rosrun flute_grinder grind probe ") + name + " " + arguments);
    return *command;
  };
  auto& face = add("end-face", "X: print the stick-out and set the work offset", "--job jobs/unequal_d12_t4.yaml");
  auto& diameter = add("diameter", "Y, on four sides: print diameter and run-out of a cylinder", "--within 2");
  auto& tooth =
      add("tooth", "A: touch the first tooth's rake face and set the work offset", "--job jobs/unequal_d12_t4.yaml");
  for (CLI::App* command : {&face, &tooth}) {
    command->add_option("--job", options.job, "job to be ground")->required()->type_name(kYamlFile);
    addFlange(*command, options.flange_mm);
  }
  for (CLI::App* command : {&face, &diameter}) {
    addLength(*command, "--within", options.within_mm, "the farthest way to the touch", false).capture_default_str();
  }
  tooth.add_option("--within", options.within_deg, "the farthest turn to the touch")
      ->type_name("DEG")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 360.0));
  addLength(diameter, "--at", options.at_mm, "sets the work offset of Y so that the diameter is this one", false);
  diameter.add_option("--job", options.job, "with --at: job to be ground")->type_name(kYamlFile);
}

void addZeros(CLI::App& app, ZerosOptions& options) {
  auto& command = addCommand(app, "zeros", "compute where the job's X, Y and Z are zero, in machine coordinates",
                             "jobs/unequal_d12_t4.yaml --stickout 62");
  addJob(command, options.job);
  addLength(command, "--stickout", options.stickout_mm, "from the collet's face to the cutter's small end", false)
      .required();
  addFlange(command, options.flange_mm);
  command.add_flag("--set", options.set, "by the geometry of the running grinder, and set them as its work offsets");
  addMachine(command, options.parameters, options.urdf);
  addJson(command, options.json);
}

/// What the command adds to the request.
std::string waiting(MachineEvent event) {
  switch (event) {
    case MachineEvent::kHome: return "; waits for the end, and Ctrl-C switches the power off";
    case MachineEvent::kLift: return "; waits for the end, and Ctrl-C and Ctrl-Z stop it";
    case MachineEvent::kCancel: return ", whoever started it; waits for the end";
    default: return "";
  }
}

/// The commands without arguments.
void addCalls(CLI::App& app, bool& status_json) {
  addJson(addCommand(app, "status", "print what the grinder is doing"), status_json);
  for (const EventRow& row : kMachineEvents) {
    if (isTrigger(row.value) || isStop(row.value)) addCommand(app, row.name, row.help + waiting(row.value));
  }
}

void addCompletion(CLI::App& app, std::string& shell) {
  auto& command = addCommand(app, "completion", "print a script that completes command lines; source it", "bash");
  const std::string bash = "bash";
  command.add_option("SHELL", shell, "for which shell")
      ->required()
      ->check(CLI::IsMember({bash}).description(""))
      ->type_name("{" + bash + "}");
}

/// All options of the command line.
struct Options {
  TableOptions table;
  PlanOptions plan;
  SimulateOptions simulate;
  SetupOptions setup;
  RunOptions run;
  ReportOptions report;
  HistoryOptions history;
  WheelOptions wheel;
  JogOptions jog;
  ZerosOptions zeros;
  ProbeOptions probe;
  double percent = 100;
  double swivel_deg = 0;
  bool status_json = false;
  OffsetsOptions offsets;
  TouchOffOptions touch_off;
  std::string shell;
};

void addCommands(CLI::App& app, Options& options) {
  app.require_subcommand(1);
  app.footer("Example:\n  rosrun flute_grinder grind plan --help");
  app.add_option("--node", options.run.node, "name of the grinder's node")->capture_default_str();
  addTable(app, options.table);
  addPlan(app, options.plan);
  addSetup(app, options.setup);
  addSimulate(app, options.simulate);
  addRun(app, options.run);
  addReport(app, options.report);
  addHistory(app, options.history);
  addWheel(app, options.wheel);
  addZeros(app, options.zeros);
  addOverride(app, options.percent);
  addConfirmSwivel(app, options.swivel_deg);
  addJog(app, options.jog);
  addCalls(app, options.status_json);
  addOffsets(app, options.offsets);
  addTouchOff(app, options.touch_off);
  addProbe(app, options.probe);
  addCompletion(app, options.shell);
}

int carryOutWheel(const CLI::App& wheel, const WheelOptions& options) {
  const std::string command = wheel.get_subcommands().front()->get_name();
  if (command == "measure") return measureWheel(options);
  if (command == "dress") return dressWheel(options);
  return showWheel(options);
}

int carryOutProbe(const CLI::App& probe, const std::string& node, const ProbeOptions& options) {
  const std::string command = probe.get_subcommands().front()->get_name();
  if (command == "diameter") return probeDiameter(node, options);
  if (command == "tooth") return probeTooth(node, options);
  return probeEndFace(node, options);
}

/// Runs the parsed command.
int carryOut(const CLI::App& app, const Options& options) {
  const std::string command = app.get_subcommands().front()->get_name();
  if (command == "completion") return std::fputs(bashCompletion(app).c_str(), stdout), 0;
  if (command == "table") return runTable(options.table);
  if (command == "plan") return runPlan(options.plan);
  if (command == "setup") return runSetup(options.setup);
  if (command == "simulate") return runSimulate(options.simulate);
  if (command == "wheel") return carryOutWheel(*app.get_subcommands().front(), options.wheel);
  if (command == "zeros" && !options.zeros.set) return printZeros(options.zeros);
  if (command == "report") writeReport(options.report);
  const std::string& node = options.run.node;
  if (command == "history") return printHistory(node, options.history);
  if (!awaitMaster()) return 1;
  if (command == "run") return runJob(options.run);
  if (command == "zeros") return setZeros(node, options.zeros);
  if (command == "offsets") return runOffsets(node, options.offsets);
  if (command == "touch-off") return runTouchOff(node, options.touch_off);
  if (command == "probe") return carryOutProbe(*app.get_subcommands().front(), node, options.probe);
  if (command == "status") return printStatus(node, options.status_json);
  if (command == "override") return setFeedOverride(node, options.percent);
  if (command == "confirm-swivel") return confirmSwivel(node, options.swivel_deg);
  if (command == "jog") {
    const auto axis = static_cast<int>(std::string(kAxisLetters).find(options.jog.axis));
    return jog(node, axis, options.jog.distance, options.jog.feed);
  }
  const auto event = valueOf<MachineEvent>(command);
  return event ? request(node, *event) : kUsage;
}

int run(int argc, char** argv) {
  ros::init(argc, argv, "grind", ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  // If the master goes away during a call, wait for it as long as for one that is missing.
  ros::master::setRetryTimeout(kPatience);
  CLI::App app{"Plans jobs for conical end mills and operates the grinder.", "grind"};
  Options options;
  options.run.node = "grinder";
  addCommands(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  return carryOut(app, options);
}

/// Opens a closed stdin, stdout or stderr so that writing fails; otherwise the next file or connection opened would get
/// its number.
void occupyStandardStreams() {
  while (true) {
    const int descriptor = ::open("/dev/null", O_RDONLY);
    if (descriptor > STDERR_FILENO) ::close(descriptor);
    if (descriptor > STDERR_FILENO || descriptor < 0) return;
  }
}

/// @param status of the command. @return the exit status: failure if the output could not be written.
int closeOutput(int status) {
  std::fflush(stdout);
  if (std::ferror(stdout) == 0) return status;
  std::fprintf(stderr, "standard output: write failed\n");
  return status == 0 ? 1 : status;
}

}  // namespace

int main(int argc, char** argv) {
  occupyStandardStreams();
  try {
    return closeOutput(run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  } catch (...) {
    std::fprintf(stderr, "unknown error\n");
  }
  return kUsage;
}
