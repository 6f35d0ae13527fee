#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/correct.h"
#include "cli/figure_history.h"
#include "cli/goal.h"
#include "cli/history.h"
#include "cli/measured.h"
#include "cli/offline.h"
#include "cli/online.h"
#include "cli/report.h"
#include "cli/setup.h"
#include "cli/simulate.h"
#include "cli/time_text.h"

#include <memory>
#include <stdexcept>

namespace grinder {

namespace {

/// Adds the choice of a recorded run: a file, or the grinder's newest record. @param words description of the file.
template <typename Options>
void addRecorded(CLI::App& command, const char* words, Options& options) {
  auto* file = command.add_option("FILE", options.file, words)->type_name(kAnyFile);
  auto* last = command.add_flag("--last", options.last, "the newest record that the grinder has kept by itself");
  last->excludes(file);
  command.add_option("--from", options.folder, "folder of the records (default: the grinder's below ~/.ros)")
      ->needs(last)
      ->type_name(kFolder);
}

/// Adds the folder of one grinder's records.
void addRecords(CLI::App& command, std::string& folder) {
  command.add_option("--from", folder, "folder of the records (default: the grinder's below ~/.ros)")
      ->type_name(kFolder);
}

/// Adds the choice of a tool by the number with which its record's name begins.
void addTool(CLI::App& command, const char* name, std::uint64_t& number, const char* description) {
  command.add_option(name, number, description)
      ->type_name("NUMBER")
      ->check(within(1, 9999999999, "as its record's name begins"));
}

void addTable(Commands& commands) {
  const auto options = std::make_shared<TableOptions>();
  auto& command =
      commands.add("table", "interpolate the job's curve with a fixed step length, as in the paper's Table 1",
                   "jobs/paper.yaml --step-length 0.2 --even-step exact", [options] { return runTable(*options); });
  addJob(command, options->job);
  command.add_option("--step-length", options->step_length_mm, "step length in mm; A is weighted by rotary_scale")
      ->required()
      ->check(within(1e-4, 100, "mm"));
  addChoice(command, "--even-step", options->even_step, "instead of the job's rule");
  addCsv(command, options->csv, "write the points to this file");
  addJson(command, options->json);
}

void addPlan(Commands& commands) {
  const auto options = std::make_shared<PlanOptions>();
  auto& command = commands.add("plan", "generate and check every setpoint of the job, from the park position",
                               "jobs/paper.yaml --csv setpoints.csv", [options] { return runPlan(*options); });
  addJob(command, options->job);
  addOperation(command, options->operation);
  addCsv(command, options->csv, "write the setpoints to this file");
  addMachine(command, options->parameters, options->urdf);
  addJson(command, options->json);
}

void addSetup(Commands& commands) {
  const auto options = std::make_shared<SetupOptions>();
  auto& command =
      commands.add("setup", "solve swivel, height and depth of the wheel for the tool that the job asks for",
                   "jobs/paper.yaml --write", [options] { return runSetup(*options); });
  addJob(command, options->job);
  addOperation(command, options->operation);
  command.add_flag("--write", options->write, "write the set-up file that the job file names");
  addMachine(command, options->parameters, options->urdf);
  addJson(command, options->json);
}

void addSimulate(Commands& commands) {
  const auto options = std::make_shared<SimulateOptions>();
  auto& command = commands.add("simulate", "compute and measure the cutter that a job grinds or a run has ground",
                               "jobs/paper.yaml --at 1,17,29",
                               [&commands, options] { return runSimulate(commands.node, *options); });
  addRecorded(command, "job file, record of 'grind history', or bag of 'roslaunch ... bag:=true'", *options);
  auto* at = command.add_option("--at", options->at_mm, "X of the sections in mm, separated by commas")->delimiter(',');
  at->type_name("MM,MM,...");
  command.add_option("--sections", options->sections, "number of sections over the flute's length (default: 9)")
      ->excludes(at)
      ->check(within(2, kMaxSections, "sections"));
  addCsv(command, options->csv, "write the figures of every section and tooth to this file");
  command.add_option("--stl", options->stl, "write the cutter as a solid to this file, in mm")->type_name(kAnyFile);
  command.add_option("--svg", options->svg, "draw the sections at both ends and in the middle, and the figures over X")
      ->type_name(kAnyFile);
  command.add_option("--job", options->job, "job file of a bag that does not have its job")->type_name(kYamlFile);
  addOperation(command, options->operation);
  addCountedJob(command, "--run", options->run);
  addJson(command, options->json);
}

void addRun(Commands& commands) {
  const auto options = std::make_shared<RunOptions>();
  auto& command = commands.add("run", "grind the job; Ctrl-C cancels it and waits until it has ended, Ctrl-Z holds it",
                               "jobs/paper.yaml --csv streamed.csv",
                               commands.online([&commands, options] { return runJob(commands.node, *options); }));
  addJob(command, options->job);
  addOperation(command, options->operation);
  command.add_flag("--dry-run", options->dry_run, "plan, check and show the path, but move nothing");
  command.add_flag("--continue", options->go_on, "continue at the first unfinished pass in the grinder's journal");
  addAnswer(command, options->answers,
            {NeedAnswer::kDiscard, NeedAnswer::kConfirmWheel, NeedAnswer::kFitOffsets, NeedAnswer::kIgnoreOffsets,
             NeedAnswer::kConfirmSwivel});
  addCsv(command, options->csv, "write the streamed setpoints to this file");
}

void addGoal(Commands& commands) {
  const auto job = std::make_shared<std::string>(), operation = std::make_shared<std::string>();
  auto& command =
      commands.add("goal", "write the goal that run sends for the job: a serialized flute_grinder/GrindGoal",
                   "jobs/paper.yaml > goal", [job, operation] { return writeGoal(*job, *operation); });
  addJob(command, *job);
  addOperation(command, *operation);
}

CLI::Option& addTolerances(CLI::App& command, std::string& path, const std::string& words) {
  return *command.add_option("--tolerances", path, words + " (default: config/tolerances.yaml)")->type_name(kYamlFile);
}

void addReport(Commands& commands) {
  const auto options = std::make_shared<ReportOptions>();
  auto& command =
      commands.add("report", "draw a recorded run, and pass or fail the ground tool", "--last -o report.html",
                   [&commands, options] { return writeReport(commands.node, *options); });
  addRecorded(command, "record of 'grind history', or bag of 'roslaunch ... bag:=true'", *options);
  command.add_option("-o,--output", options->html, "HTML file to write")->type_name(kAnyFile);
  command.add_option("--pdf", options->pdf, "PDF file to write, by Chromium")->type_name(kAnyFile);
  addJson(command, options->json);
  command.add_option("--note", options->note, "the operator's words for the first page")->type_name("TEXT");
  command.add_option("--operator", options->operator_name, "who ground the tool, for every page")->type_name("NAME");
  command.add_option("--serial", options->serial, "serial number of the tool, for every page")->type_name("NUMBER");
  addTolerances(command, options->tolerances, "what the tool is passed by");
  addCountedJob(command, "--job", options->job);
}

/// Adds a day or time of `grind history`. @param last see timeOfDate().
void addDate(CLI::App& command, const char* name, std::string& date, bool last, const char* description) {
  const auto check = [last](const std::string& text) {
    try {
      timeOfDate(text, last);
      return std::string();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  command.add_option(name, date, description)->type_name("DATE")->check(check);
}

/// Adds the options of a figure over the tools of a job, which go with --from of one folder and --json alone.
void addFigureHistory(CLI::App& command, FigureHistoryOptions& options) {
  auto* figure =
      command.add_option("--figure", options.figure, "instead, what was measured of this figure of a job's tools")
          ->type_name("FIGURE[@X]");
  auto* job = command.add_option("--job", options.job, "with --figure: the job")->type_name(kYamlFile);
  figure->needs(job);
  job->needs(figure);
  addOperation(command, options.operation).needs(figure);
  command.add_option("--svg", options.svg, "with --figure: draw it into this file")->needs(figure)->type_name(kAnyFile);
  for (const char* other : {"--grinder", "--tool", "--since", "--until", "--verdict", "--judge-again", "--csv"}) {
    figure->excludes(other);
  }
}

void addHistory(Commands& commands) {
  const auto options = std::make_shared<HistoryOptions>();
  const auto figure = std::make_shared<FigureHistoryOptions>();
  auto& command = commands.add("history", "list the records of one or many grinders' last jobs, the newest last",
                               "--from left right --since 2026-11-01 --verdict failed", [&commands, options, figure] {
                                 if (figure->figure.empty()) return printHistory(commands.node, *options);
                                 if (options->folders.size() > 1) {
                                   throw std::invalid_argument(
                                       "--figure shows the tools of one grinder; allowed: one "
                                       "folder of --from");
                                 }
                                 const std::string folder = options->folders.empty() ? "" : options->folders.front();
                                 return printFigureHistory(commands.node, folder, *figure, options->json);
                               });
  auto* from = command.add_option("--from", options->folders,
                                  "folders of the records, one for each grinder (default: the grinder's below ~/.ros)");
  from->type_name(kFolder);
  command.add_option("--grinder", options->grinder, "only of this one: a name in its folder's path")
      ->needs(from)
      ->type_name("NAME");
  command.add_option("--tool", options->tool, "only with this in the job's name or the tool")->type_name("TEXT");
  addDate(command, "--since", options->since, false,
          "only of jobs that started then or later; 2026-11-22T18:04 or ...22");
  addDate(command, "--until", options->until, true, "only of jobs that started until then, on that day included");
  command.add_option("--verdict", options->verdict, "only with this one; incomplete: passed as far as measured")
      ->check(CLI::IsMember({"passed", "incomplete", "failed"}).description(""))
      ->type_name("{passed|incomplete|failed}");
  auto* again =
      command.add_flag("--judge-again", options->judge_again,
                       "first measure the tools that were not, judge all, and keep the verdicts in the records");
  addTolerances(command, options->tolerances, "what they are judged by").needs(again);
  addJson(command, options->json);
  addCsv(command, options->csv, "write the list to this file");
  addFigureHistory(command, *figure);
}

void addMeasured(Commands& commands) {
  const auto options = std::make_shared<MeasuredOptions>();
  auto& command = commands.add("measured", "keep what was measured of a ground tool in its record",
                               "jobs/paper.yaml core@2=7.16 rake@15=8.3",
                               [&commands, options] { return keepMeasured(commands.node, *options); });
  addJob(command, options->job);
  command.add_option("FIGURE=VALUE", options->figures, "figures at their X, such as rake@15=8.3, in mm or deg")
      ->required()
      ->type_name("FIGURE@X=VALUE");
  addOperation(command, options->operation);
  addTool(command, "--tool", options->tool, "the tool (default: the last one of the job)");
  addRecords(command, options->folder);
}

void addCorrect(Commands& commands) {
  const auto options = std::make_shared<CorrectOptions>();
  const auto act = [&commands, options] { return correct(commands.node, *options); };
  auto& command = commands.add(
      "correct", "print, or set, what makes the next tool as planned, by measured tools", "jobs/paper.yaml",
      [options, act, online = commands.online(act)] { return options->apply ? online() : act(); });
  addJob(command, options->job);
  addOperation(command, options->operation);
  addTool(command, "--since", options->since,
          "the first tool that counts (default: the first with the zero points of the last)");
  auto* apply = command.add_flag("--apply", options->apply, "set the work offsets of Y and Z");
  addAnswer(command, options->answers, {NeedAnswer::kSetOffset})->needs(apply);
  addRecords(command, options->folder);
  addMachine(command, options->parameters, options->urdf);
  addJson(command, options->json);
}

}  // namespace

void addJobCommands(Commands& commands) {
  addTable(commands);
  addPlan(commands);
  addSetup(commands);
  addSimulate(commands);
  addRun(commands);
  addGoal(commands);
  addReport(commands);
  addHistory(commands);
  addMeasured(commands);
  addCorrect(commands);
}

}  // namespace grinder
