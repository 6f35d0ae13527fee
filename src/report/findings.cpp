#include "flute_grinder/report/findings.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/record/cycle_figures.h"
#include "flute_grinder/record/job_events.h"
#include "flute_grinder/record/machine_info.h"
#include "report/motion.h"
#include "report/plots.h"

#include <algorithm>

namespace grinder {

namespace {

using namespace units;

constexpr double kMillisecond = 1e-3;

/// Key and description of a kind of file.
std::pair<const char*, const char*> namesOf(FileKind kind) {
  switch (kind) {
    case FileKind::kTable: return {"table", "points of a curve, from \"grind table\""};
    case FileKind::kPlan: return {"setpoints", "setpoints, from \"grind plan\""};
    case FileKind::kRun: return {"run", "setpoints, from \"grind run\""};
    case FileKind::kBag: return {"bag", "bag of the grinder"};
    default: return {"record", "the grinder's own record"};
  }
}

Json headOf(FileKind kind, const ReportContext& context) {
  const auto [key, description] = namesOf(kind);
  Json data{{"file", context.file}, {"kind", key}, {"type", description}};
  data.update(context.words);
  return data;
}

/// What a report lacks, and why.
Json leftOut(const RunFile& run, const Json& data, const std::string& no_tool) {
  Json reasons = Json::array();
  if (!run.summary().worst) reasons.push_back("Curve, error and feed: the job ended before its first stroke.");
  switch (run.kind()) {
    case FileKind::kTable:
      reasons.push_back(
          "Feed, axis speeds and accelerations, following error, loop timing: the points of a table have no time.");
      break;
    case FileKind::kPlan:
      reasons.push_back(
          "Following error and loop timing: the CSV file of a plan has only commanded values; a bag has more.");
      break;
    case FileKind::kRun: reasons.push_back("Loop timing: a CSV file does not have it; a bag does."); break;
    default: break;
  }
  if (run.kind() != FileKind::kBag) {
    reasons.push_back(
        "The tool and its tolerances: a CSV file does not have the job; a bag or a record of the grinder does.");
  } else if (!no_tool.empty()) {
    reasons.push_back("The ground tool: " + no_tool);
  } else if (!allTeethGround(data["tool"])) {
    reasons.push_back(
        "The tolerances of the ground tool: not all of its teeth were ground in this job; the others are not in the "
        "file.");
  }
  return reasons;
}

}  // namespace

void Survey::MaxOfAxes::add(bool in_stroke, const Axes& values) {
  Axes& part = in_stroke ? stroke : rapid;
  part = part.max(values.abs());
}

Survey::Survey(const RunFile& run, const std::optional<ValidJob>& job, bool draws)
    : run_(run),
      motion_(std::make_unique<MotionOfRows>(run)),
      plots_(draws ? std::make_unique<Plots>(run) : nullptr),
      strokes_(job ? StrokeLog(*job) : StrokeLog()) {}

Survey::~Survey() = default;

void Survey::add(const RunRow& row) {
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

Json Survey::plots() const { return plots_->json(); }

Json Survey::findings(const ReportContext& context) const {
  Json data = headOf(run_.kind(), context);
  data.update(run_.head());
  escapeTexts(data);
  if (run_.job()) {
    data["job"] = {{"name", data.value("job_name", "")}, {"file", toJson(**run_.job())}};
    data.erase("job_name");
  }
  if (!context.tool.is_null()) data["tool"] = context.tool;
  // As `grind table` and the paper count them: point 0 is where the curve starts.
  data["points"] = run_.summary().count - (run_.kind() == FileKind::kTable ? 1 : 0);
  data["odd_error_rad"] = run_.summary().odd_error;
  data["even_error_rad"] = run_.summary().even_error;
  if (run_.kind() != FileKind::kTable) {
    data.update(ofSetpoints());
    data["axes"] = axesJson(data.contains("machine") ? data["machine"] : toJson(context.limits));
  }
  if (run_.kind() == FileKind::kBag) data.update(loopJson());
  if (data.contains("job")) addVerdict(data, context.tolerances);
  data["left_out"] = leftOut(run_, data, context.no_tool);
  return data;
}

Json Survey::ofSetpoints() const {
  const RowSummary& all = run_.summary();
  Json data{{"setpoints", {{"written", all.count + all.missing}, {"lost", all.missing}}},
            {"period_ms", run_.period() / kMillisecond},
            {"duration_s", all.end - all.begin},
            {"strokes", strokes_.json(run_.hasActual())}};
  data.update(holdsAndOverrides());
  return data;
}

Json Survey::holdsAndOverrides() const {
  JobEvents events;
  double feed_override = 1;
  for (const StateChange& change : run_.states()) {
    // What is changed after the job is not part of it.
    if (change.time < run_.summary().end) feed_override = change.feed_override;
    events.add(std::max(change.time, 0.0), change.held, change.reason, feed_override, change.pass);
  }
  return {{"holds", events.holds()}, {"overrides", events.overrides()}};
}

Json Survey::axesJson(const Json& limits) const {
  struct Quantity {
    const char* key;
    const MaxOfAxes& max;
    const char* limit;
  };
  std::vector<Quantity> quantities{{"speed", speed_, "max_velocity"},
                                   {"acceleration", acceleration_, "max_acceleration"}};
  if (run_.hasActual()) quantities.push_back({"following", following_, "max_following_error"});
  Json rows = Json::array();
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const double unit = axis == kA ? kDegree : kMillimetre;
    Json row{{"axis", std::string(1, "XYZA"[axis])}};
    for (const Quantity& quantity : quantities) {
      row[quantity.key] = {{"stroke", quantity.max.stroke[axis] / unit},
                           {"rapid", quantity.max.rapid[axis] / unit},
                           {"limit", std::next(limits[quantity.limit].begin(), axis).value()}};
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json Survey::loopJson() const {
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

Json findingsOfRecord(const Json& record, const ReportContext& context) {
  Json data = headOf(FileKind::kRecord, context);
  data.update(record);
  if (!context.tool.is_null()) data["tool"] = context.tool;
  judgeRecord(data, context.tolerances);
  data["left_out"] = {
      "Pictures of the axes: a record of the grinder keeps each stroke's figures only; a bag (bag:=true) has every "
      "setpoint. The tool is the one that the job asks for, not measured."};
  if (!context.no_tool.empty()) data["left_out"].push_back("The ground tool: " + context.no_tool);
  return data;
}

}  // namespace grinder
