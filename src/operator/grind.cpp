#include "flute_grinder/core/feed_schedule.h"
#include "flute_grinder/core/job_file.h"
#include "flute_grinder/drive/machine_config.h"
#include "flute_grinder/operator/csv.h"
#include "flute_grinder/operator/offline.h"
#include "flute_grinder/operator/online.h"
#include "flute_grinder/operator/report.h"

#include <ros/package.h>
#include <ros/ros.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>

namespace {

using namespace flute_grinder;

constexpr int kUsage = 2;  ///< exit status for wrong usage and unreadable files

void addJob(CLI::App& command, std::string& job) {
  command.add_option("JOB", job, "job file (YAML, mm, deg, mm/min)")->required();
}

void addTable(CLI::App& app, TableOptions& options) {
  auto& command =
      *app.add_subcommand("table", "interpolate the job's curve with a fixed step length, as the paper's Table 1");
  addJob(command, options.job);
  command.add_option("--step-length", options.step_length_mm, "length of a step in mm, where A counts by rotary_scale")
      ->required()
      ->check([](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return value >= 1e-4 && value <= 100 ? "" : text + "; allowed: 0.0001 to 100 mm";
      });
  const std::map<std::string, EvenStepRule> rules{{toString(EvenStepRule::kPublished), EvenStepRule::kPublished},
                                                  {toString(EvenStepRule::kThirdOrder), EvenStepRule::kThirdOrder},
                                                  {toString(EvenStepRule::kExact), EvenStepRule::kExact}};
  command
      .add_option_function<EvenStepRule>(
          "--even-step", [&](const EvenStepRule& rule) { options.even_step = rule; }, "in place of the job's rule")
      ->transform(CLI::CheckedTransformer(rules));
  command.add_option("--csv", options.csv, "write the points to this file");
}

void addPlan(CLI::App& app, PlanOptions& options) {
  auto& command = *app.add_subcommand("plan", "generate and check every setpoint of the job, from the park position");
  addJob(command, options.job);
  command.add_option("--csv", options.csv, "write the setpoints to this file");
  command.add_option("--machine", options.parameters, "parameters of the machine (default: config/grinder.yaml)");
  command.add_option("--urdf", options.urdf, "robot description (default: urdf/grinder.urdf)");
}

void addRun(CLI::App& app, RunOptions& options) {
  auto& command = *app.add_subcommand("run", "grind the job; Ctrl-C cancels it and waits for the stop");
  addJob(command, options.job);
  command.add_flag("--dry-run", options.dry_run, "plan, check and show the path, but move nothing");
  command.add_flag("--continue", options.go_on,
                   "begin at the first pass that was not finished, by the grinder's journal");
  command.add_option("--csv", options.csv, "write the setpoints as streamed to this file");
}

void addOverride(CLI::App& app, double& percent) {
  auto& command = *app.add_subcommand("override", "set the feed override; 0 stops the feed, rapids keep their speed");
  command.add_option("PERCENT", percent, "of the job's feed, 0 to 120")->required()->check([](const std::string& text) {
    const double value = std::strtod(text.c_str(), nullptr);
    return value >= 0 && value <= kMaxFeedOverride * 100 ? "" : text + "; allowed: 0 to 120 %";
  });
}

/// Carried out as soon as it is parsed.
void addReport(CLI::App& app, ReportOptions& options) {
  auto& command = *app.add_subcommand("report", "draw a table, a plan or a record as one HTML file");
  command.add_option("FILE", options.file, "CSV file of table, plan or run, or a bag of 'roslaunch ... record:=true'")
      ->required();
  command.add_option("-o,--output", options.output, "HTML file to write")->required();
  command.add_option("--job", options.job, "which of a bag's jobs, counted from 1 (default: the last)")
      ->check([](const std::string& text) {
        return std::strtol(text.c_str(), nullptr, 10) >= 1 ? "" : text + "; allowed: 1 or more";
      });
  command.add_option("--machine", options.parameters, "parameters of the machine (default: config/grinder.yaml)");
  command.add_option("--urdf", options.urdf, "robot description (default: urdf/grinder.urdf)");
  command.callback([&options] {
    const std::string package = ros::package::getPath("flute_grinder");
    if (options.parameters.empty()) options.parameters = package + "/config/grinder.yaml";
    if (options.urdf.empty()) options.urdf = package + "/urdf/grinder.urdf";
    writeReport(options);
  });
}

/// What the command line asks for; called once it is parsed.
int carryOut(const CLI::App& app, const TableOptions& table, PlanOptions& plan, const RunOptions& run, double percent) {
  if (app.got_subcommand("table")) return runTable(table);
  if (app.got_subcommand("plan")) {
    const std::string package = ros::package::getPath("flute_grinder");
    if (plan.parameters.empty()) plan.parameters = package + "/config/grinder.yaml";
    if (plan.urdf.empty()) plan.urdf = package + "/urdf/grinder.urdf";
    return runPlan(plan);
  }
  if (!awaitMaster()) return 1;
  if (app.got_subcommand("run")) return runJob(run);
  if (app.got_subcommand("status")) return printStatus(run.node);
  if (app.got_subcommand("home")) return home(run.node);
  if (app.got_subcommand("override")) return setFeedOverride(run.node, percent);
  const std::string command = app.get_subcommands().front()->get_name();
  return callTrigger(run.node, command == "reset" ? "reset_fault" : command);
}

int run(int argc, char** argv) {
  ros::init(argc, argv, "grind", ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  CLI::App app{"Grinds the flutes of conical end mills: looks at jobs, and works the grinder.", "grind"};
  app.require_subcommand(1);
  TableOptions table;
  PlanOptions plan;
  RunOptions run;
  run.node = "grinder";
  app.add_option("--node", run.node, "name of the grinder's node")->capture_default_str();
  addTable(app, table);
  addPlan(app, plan);
  addRun(app, run);
  ReportOptions report;
  addReport(app, report);
  double percent = 100;
  addOverride(app, percent);
  app.add_subcommand("status", "print what the grinder is doing");
  app.add_subcommand("enable", "switch the drive's power on");
  app.add_subcommand("disable", "switch the drive's power off");
  app.add_subcommand("home", "find the axes' reference, and wait until it is found");
  app.add_subcommand("hold", "stop on the path");
  app.add_subcommand("resume", "go on after hold or retract");
  app.add_subcommand("retract", "after hold, lift the wheel off the work");
  app.add_subcommand("reset", "reset a fault; the machine is then disabled");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  return carryOut(app, table, plan, run, percent);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  } catch (...) {
    std::fprintf(stderr, "unknown error\n");
  }
  return kUsage;
}
