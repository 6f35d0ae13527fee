#include "flute_grinder/report/findings.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/record/cycle_figures.h"
#include "flute_grinder/record/job_events.h"
#include "flute_grinder/record/measured_tools.h"
#include "flute_grinder/tool/pass_removal.h"
#include "report/motion.h"
#include "report/plots.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iterator>
#include <utility>

namespace grinder {

namespace {

using namespace units;

constexpr double kMillisecond = 1e-3;

Json headOf(const char* kind, const char* type, const ReportContext& context) {
  Json data{{"file", context.file}, {"kind", kind}, {"type", type}};
  data.update(context.words);
  return data;
}

void addTool(Json& data, const ReportContext& context) {
  if (context.tool) data["tool"] = context.tool_json;
  if (!context.no_tool.empty()) data["left_out"].push_back("The ground tool: " + context.no_tool);
  if (!context.tool || context.tool->allTeethGround()) return;
  data["left_out"].push_back(
      "The tolerances of the ground tool: not all of its teeth were ground in this job; the others are not in the "
      "file.");
}

void addVerdict(Json& data, const std::vector<Criterion>& criteria, const Verdict& verdict) {
  data["criteria"] = toJson(criteria);
  data["verdict"] = verdict.verdict;
  data["verdict_because"] = verdict.because;
}

}  // namespace

void RunFindings::MaxOfAxes::add(bool in_stroke, const Axes& values) {
  Axes& part = in_stroke ? stroke : rapid;
  part = part.max(values.abs());
}

RunFindings::RunFindings(const BagRun& run, const std::optional<ValidJob>& job, bool draws)
    : run_(run),
      motion_(std::make_unique<MotionOfRows>(run)),
      plots_(draws ? std::make_unique<Plots>(run) : nullptr),
      strokes_(job ? StrokeLog(*job) : StrokeLog()) {}

RunFindings::~RunFindings() = default;

void RunFindings::add(const RunRow& row) {
  const bool in_stroke = row.setpoint.step != StepKind::kNone;
  const AxisMotion motion = motion_->add(row);
  if (motion.speed) speed_.add(in_stroke, *motion.speed);
  if (motion.acceleration) acceleration_.add(in_stroke, *motion.acceleration);
  if (motion.following_error) following_.add(in_stroke, *motion.following_error);
  if (in_stroke) strokes_.add(row.setpoint, row.time);
  if (in_stroke && motion.following_error) strokes_.addFollowingError(motion.following_error->abs());
  shortest_ = count_ == 0 ? row.cycle_period : std::min(shortest_, row.cycle_period);
  updateMax(longest_, row.cycle_period);
  sum_ += row.cycle_period;
  ++count_;
  if (isLate(row.cycle_period, run_.period())) ++late_;
  if (plots_) plots_->add(row, motion);
}

Json RunFindings::plots() const { return plots_->json(); }

Json RunFindings::json(const ReportContext& context) const {
  Json data = headOf("bag", "bag of the grinder", context);
  data.update(run_.head());
  escapeTexts(data);
  data["left_out"] = Json::array();
  if (!run_.summary().worst) {
    data["left_out"].push_back("Curve, error and feed: the job ended before its first stroke.");
  }
  data["points"] = run_.summary().count;
  data["odd_error_rad"] = run_.summary().odd_error;
  data["even_error_rad"] = run_.summary().even_error;
  data.update(ofSetpoints());
  data["axes"] = axesJson(data.value("machine", Json::object()));
  data.update(loopJson());
  if (run_.job()) {
    data["job"] = {{"name", data.value("job_name", "")}, {"file", toJson(**run_.job())}};
    data.erase("job_name");
    judge(data, context);
  }
  addTool(data, context);
  return data;
}

void RunFindings::judge(Json& data, const ReportContext& context) const {
  const RowSummary& all = run_.summary();
  std::vector<Criterion> criteria =
      criteriaOfTool(*run_.job(), context.tool ? &*context.tool : nullptr, context.tolerances);
  const RunFacts facts{*run_.job(), strokes_.strokes(), run_.feedLimits(), all.count + all.missing, late_, longest_};
  for (Criterion& criterion : criteriaOfRun(facts, context.tolerances)) criteria.push_back(std::move(criterion));
  addVerdict(data, criteria, verdictOn(criteria, run_.outcome(), all.missing));
}

Json RunFindings::ofSetpoints() const {
  const RowSummary& all = run_.summary();
  Json data{{"setpoints", {{"written", all.count + all.missing}, {"lost", all.missing}}},
            {"period_ms", run_.period() / kMillisecond},
            {"duration_s", all.end - all.begin},
            {"strokes", strokes_.json()}};
  data.update(holdsAndOverrides());
  return data;
}

Json RunFindings::holdsAndOverrides() const {
  JobEvents events;
  double feed_override = 1;
  for (const StateChange& change : run_.states()) {
    // A change of the override after the job is not part of it.
    if (change.time < run_.summary().end) feed_override = change.feed_override;
    events.add(std::max(change.time, 0.0), change.held, change.reason, feed_override, change.pass);
  }
  return {{"holds", events.holds()}, {"overrides", events.overrides()}};
}

/// @param machine machine of a record; empty if unknown.
Json RunFindings::axesJson(const Json& machine) const {
  struct Quantity {
    const char* key;
    const MaxOfAxes& max;
    const char* limit;
  };
  const Quantity quantities[]{{"speed", speed_, "max_velocity"},
                              {"acceleration", acceleration_, "max_acceleration"},
                              {"following", following_, "max_following_error"}};
  Json rows = Json::array();
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const double unit = shopScale(unitOf(axis, 0));
    Json row{{"axis", std::string(1, axisLetter(axis))}};
    const auto limit = [&](const char* key) {
      return machine.empty() ? Json(nullptr) : Json(std::next(machine.at(key).begin(), axis).value());
    };
    for (const Quantity& quantity : quantities) {
      row[quantity.key] = {{"stroke", quantity.max.stroke[axis] / unit},
                           {"rapid", quantity.max.rapid[axis] / unit},
                           {"limit", limit(quantity.limit)}};
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json RunFindings::loopJson() const {
  Json states = Json::array(), diagnostics = Json::array();
  for (const StateChange& change : run_.states()) {
    if (!states.empty() && states.back()["state"] == change.state && states.back()["reason"] == change.reason) continue;
    states.push_back({{"at_s", change.time}, {"state", change.state}, {"reason", change.reason}});
  }
  for (const auto& [name, worst] : run_.diagnostics()) {
    diagnostics.push_back({{"name", name}, {"level", worst.level}, {"message", worst.message}, {"count", worst.count}});
  }
  return {{"late_cycles", {{"count", late_}, {"longest_ms", longest_ / kMillisecond}}},
          {"loop",
           {{"mean_ms", sum_ / static_cast<double>(count_) / kMillisecond},
            {"shortest_ms", shortest_ / kMillisecond},
            {"longest_ms", longest_ / kMillisecond}}},
          {"states", states},
          {"diagnostics", diagnostics}};
}

namespace {

/// A record with the keys of a bag's findings.
Json documentOf(const Record& record) {
  Json data = toJson(record.head);
  data.update(record.body);
  data["setpoints"] = {{"written", record.head.setpoints}, {"lost", record.head.lost}};
  for (const char* key : {"criteria", "ground", "not_ground"}) data.erase(key);
  return data;
}

Json documentOf(const ToolRecords::Operation& operation) {
  Json runs = Json::array(), missing = Json::array();
  for (const Record& record : operation.records) runs.push_back(documentOf(record));
  for (const ToothPass& place : operation.missing()) {
    missing.push_back({{"tooth", place.tooth + 1}, {"pass", place.pass + 1}});
  }
  return {{"operation", operation.name()},
          {"process", toJson(operation.asked)["operations"][static_cast<std::size_t>(operation.asked.operation)]},
          {"files", operation.files},
          {"runs", runs},
          {"missing", missing}};
}

/// What was measured of an operation, each figure with those of the tools before. @throw std::exception
Json measuredOver(const std::string& folder, const ToolRecords::Operation& operation) {
  Json all = Json::array();
  const Record& last = operation.records.back();
  const std::vector<MeasuredFigure> figures = measuredOf(last);
  if (figures.empty()) return all;
  std::vector<ToolNumber> numbers = toolsIn(folder, last.head.digest);
  const auto is_this = [&](const ToolNumber& tool) {
    return std::filesystem::path(tool.path).filename() == operation.files.back();
  };
  const auto own = std::find_if(numbers.begin(), numbers.end(), is_this);
  if (own != numbers.end()) numbers.erase(std::next(own), numbers.end());
  const std::vector<MeasuredTool> tools = measuredTools(numbers);
  for (const MeasuredFigure& measured : figures) {
    Json& history = all.emplace_back(figureHistory(*operation.job, tools, {measured.figure, measured.x}));
    history["value"] = shopNumber(measured.value, rowOf(measured.figure).unit);
  }
  return all;
}

/// The criteria of the runs, each with its operation if there are several.
void addRuns(std::vector<Criterion>& criteria, const ToolRecords& tool, const Tolerances& tolerances) {
  for (const ToolRecords::Operation& operation : tool.operations()) {
    for (const Record& record : operation.records) {
      std::vector<Criterion> own = criteriaFrom(record.body.at("criteria"));
      judgeAgain(own, tolerances);
      for (Criterion& criterion : own) {
        if (criterion.of_tool) continue;
        if (!record.head.operation.empty()) criterion.name += ", " + record.head.operation;
        criteria.push_back(std::move(criterion));
      }
    }
  }
}

Verdict verdictOn(const std::vector<Criterion>& criteria, const ToolRecords& tool) {
  std::string outcome = "done";
  std::uint64_t lost = 0;
  std::vector<std::string> unknown;
  std::string unchecked;
  for (const ToolRecords::Operation& operation : tool.operations()) {
    const std::string words = operation.name();
    if (operation.records.empty()) {
      unknown.push_back(words + ": not in the records");
      continue;
    }
    if (outcome == "done") outcome = operation.records.back().head.outcome;
    for (const Record& record : operation.records) lost += record.head.lost;
    const auto is_unchecked = [](const Record& record) {
      return record.body.at("zero_points").at("said_right").get<bool>();
    };
    if (std::any_of(operation.records.begin(), operation.records.end(), is_unchecked)) {
      unchecked += (unchecked.empty() ? ": " : ", ") + words;
    }
    const std::size_t missing = operation.missing().size();
    if (missing > 0) unknown.push_back(format("%s: %zu stroke(s) are not in the records", words.c_str(), missing));
  }
  if (!unchecked.empty()) unknown.push_back(kNoOffsetCheck + unchecked);
  return verdictOn(criteria, outcome, lost, std::move(unknown));
}

}  // namespace

Json findingsOfTool(const ToolRecords& tool, const ReportContext& context) {
  const Record& last = tool.last().records.back();
  Json data = headOf("record", "the grinder's own records", context);
  data.update(documentOf(last));
  data["job"] = {{"name", last.head.job}, {"digest", last.head.digest}, {"file", data["job_file"]}};
  data.erase("job_file");
  data.erase("tool");
  data["operations"] = Json::array();
  Json left_out =
      Json::array({"Pictures of the axes: a record has each stroke's figures; a bag (bag:=true) has every setpoint."});
  for (const ToolRecords::Operation& operation : tool.operations()) {
    Json& one = data["operations"].emplace_back(documentOf(operation));
    if (context.tool && operation.job) one["removal"] = toJson(removalOfPasses(*operation.job));
    if (!operation.job) continue;
    try {
      one["measured"] = measuredOver(tool.folder(), operation);
    } catch (const std::exception& error) {  // of another tool's record, or of what somebody wrote into one
      left_out.push_back(std::string("What was measured: ") + error.what());
    }
  }
  data["left_out"] = left_out;
  addTool(data, context);
  std::vector<Criterion> criteria =
      criteriaOfTool(*tool.last().job, context.tool ? &*context.tool : nullptr, context.tolerances);
  addRuns(criteria, tool, context.tolerances);
  addVerdict(data, criteria, verdictOn(criteria, tool));
  return data;
}

}  // namespace grinder
