#include "flute_grinder/cli/completion.h"
#include "flute_grinder/cli/offline.h"
#include "flute_grinder/cli/online.h"
#include "flute_grinder/cli/report.h"
#include "flute_grinder/cli/state_watch.h"
#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/core/feed_schedule.h"
#include "flute_grinder/core/job_file.h"

#include <ros/package.h>
#include <ros/ros.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>

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
  std::map<std::string, EvenStepRule> rules;
  std::string names;
  for (const auto& [rule, name] : kEvenStepRules) {
    rules[name] = rule;
    names += (names.empty() ? "" : "|") + std::string(name);
  }
  command
      .add_option_function<EvenStepRule>(
          "--even-step", [&](const EvenStepRule& rule) { options.even_step = rule; }, "instead of the job's rule")
      ->transform(CLI::CheckedTransformer(rules).description(""))
      ->type_name("{" + names + "}");
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

void addReport(CLI::App& app, ReportOptions& options) {
  auto& command = addCommand(app, "report", "draw a table, a plan or a recorded run as an HTML file",
                             "setpoints.csv -o report.html");
  command.add_option("FILE", options.file, "CSV file of table, plan or run, or a bag of 'roslaunch ... record:=true'")
      ->required()
      ->type_name(kAnyFile);
  command.add_option("-o,--output", options.output, "HTML file to write")->required()->type_name(kAnyFile);
  command.add_option("--job", options.job, "which of a bag's jobs, counted from 1 (default: the last)")
      ->check([](const std::string& text) {
        return std::strtol(text.c_str(), nullptr, 10) >= 1 ? "" : text + "; allowed: 1 or more";
      });
  addMachine(command, options.parameters, options.urdf);
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
  RunOptions run;
  ReportOptions report;
  double percent = 100;
  bool status_json = false;
  std::string shell;
};

void addCommands(CLI::App& app, Options& options) {
  app.require_subcommand(1);
  app.footer("Example:\n  rosrun flute_grinder grind plan --help");
  app.add_option("--node", options.run.node, "name of the grinder's node")->capture_default_str();
  addTable(app, options.table);
  addPlan(app, options.plan);
  addRun(app, options.run);
  addReport(app, options.report);
  addOverride(app, options.percent);
  addCalls(app, options.status_json);
  addCompletion(app, options.shell);
}

/// Runs the parsed command.
int carryOut(const CLI::App& app, const Options& options) {
  const std::string command = app.get_subcommands().front()->get_name();
  if (command == "completion") return std::fputs(bashCompletion(app).c_str(), stdout), 0;
  if (command == "table") return runTable(options.table);
  if (command == "plan") return runPlan(options.plan);
  if (command == "report") writeReport(options.report);
  if (!awaitMaster()) return 1;
  const std::string& node = options.run.node;
  if (command == "run") return runJob(options.run);
  if (command == "status") return printStatus(node, options.status_json);
  if (command == "override") return setFeedOverride(node, options.percent);
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
