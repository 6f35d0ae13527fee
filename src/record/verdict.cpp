#include "flute_grinder/record/verdict.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/tool/tool_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grinder {

namespace {

using namespace units;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr const char* kFollowing = "following error in strokes";
constexpr const char* kFeed = "feed constancy";
constexpr const char* kLate = "late cycles";

/// A tolerance of the file, and its criterion.
struct ToleranceRow {
  const char* key;
  double Tolerances::*value;
  const char* criterion;
  void (*apply)(Criterion& criterion, double value);
};

void asTolerance(Criterion& criterion, double value) { criterion.tolerance = value; }

const ToleranceRow kTolerances[]{
    {"land_mm", &Tolerances::land_mm, rowOf(ToolFigure::kLand).words,
     [](Criterion& criterion, double value) { criterion.asked = value; }},
    {"edge_diameter_mm", &Tolerances::edge_diameter_mm, rowOf(ToolFigure::kEdgeDiameter).words, asTolerance},
    {"following_error_um", &Tolerances::following_error_um, kFollowing, asTolerance},
    {"feed_percent", &Tolerances::feed_percent, kFeed,
     [](Criterion& criterion, double value) { criterion.tolerance = criterion.asked.value_or(0) * value / 100; }},
    {"late_cycles_percent", &Tolerances::late_cycles_percent, kLate, asTolerance}};

void setTolerance(Criterion& criterion, const Tolerances& tolerances) {
  for (const ToleranceRow& row : kTolerances) {
    if (criterion.name == row.criterion) row.apply(criterion, tolerances.*row.value);
  }
}

/// The excess of a value's difference over its tolerance; infinite if the value cannot be compared.
double excess(std::optional<double> value, std::optional<double> asked, std::optional<double> tolerance) {
  if (!value || !asked) return kInfinity;
  const double off = tolerance ? std::abs(*value - *asked) - *tolerance : *asked - *value;
  return std::isnan(off) ? kInfinity : off;
}

double excess(const Criterion& c) { return c.missing ? kInfinity : excess(c.measured, c.asked, c.tolerance); }

bool isMeasured(const Criterion& c) { return c.measured || c.missing; }

/// Keeps a value if its excess is larger than the excess kept so far. @param value nothing or NaN for a figure that
/// does not exist where it should.
void add(Criterion& criterion, const FigureValue& value, std::string place) {
  Criterion other = criterion;
  other.missing = !value || std::isnan(*value);
  other.measured = other.missing ? std::nullopt : value;
  if (isMeasured(criterion) && !(excess(other) > excess(criterion))) return;
  other.place = std::move(place);
  other.remark = other.missing ? "there is none" : "";
  criterion = std::move(other);
}

std::string placeAt(double x) { return format("X = %.3f mm", x / kMillimetre); }

std::string placeOf(const ToothPass& place) { return format("tooth %d, pass %d", place.tooth + 1, place.pass + 1); }

std::string placeOf(const FigurePlace& p, ToolFigure figure) {
  const std::string at = placeAt(p.section.x);
  return figure == ToolFigure::kCoreDiameter ? at : format("tooth %zu, ", p.number + 1) + at;
}

/// The criterion of a figure without a measured value.
Criterion criterionOf(const ToolFigureRow& row, double asked, double tolerance) {
  const double scale = shopScale(row.unit);
  return {row.words, shopUnit(row.unit), true, 3, asked / scale, tolerance / scale, {}, false, "", ""};
}

/// The same at a place, where nothing may be asked.
Criterion criterionOf(const ToolFigureRow& row, const FigurePlace& p, const Tolerances& tolerances) {
  const FigureValue asks = asked(row.value, p);
  Criterion criterion = criterionOf(row, asks.value_or(0), asks ? tolerance(row.value, p) : 0);
  if (!asks) criterion.asked = criterion.tolerance = std::nullopt;
  setTolerance(criterion, tolerances);
  return criterion;
}

bool isJudged(const ToolFigureRow& row, const FigurePlace& p) {
  if (row.of == StrokeForm::kStraight) return false;
  if (row.of == StrokeForm::kRelief && !p.job->hasGround(OperationKind::kPrimaryRelief)) return false;
  return row.value == ToolFigure::kLand || asked(row.value, p).has_value();
}

/// Whether a figure must exist at a place: an allowed incomplete flute has no rake face at its end.
bool counts(const ToolFigureRow& row, const FigurePlace& p) {
  return !row.of_complete || p.tooth().complete || !p.job->process().incomplete_ok;
}

/// Adds the value with the largest excess of all teeth in all sections.
void addFigure(Criterion& criterion, const ToolFigureRow& row, const GroundTool& tool, const Tolerances& tolerances) {
  for (const MeasuredSection& section : tool.sections) {
    for (std::size_t tooth = 0; tooth < section.ground.teeth.size(); ++tooth) {
      const FigurePlace p{tool.job, section.ground, tooth};
      if (!counts(row, p)) continue;
      Criterion here = criterionOf(row, p, tolerances);
      FigureValue value = measured(row.value, p);
      if (value) *value /= shopScale(row.unit);
      add(here, value, placeOf(p, row.value));
      if (!isMeasured(criterion) || excess(here) > excess(criterion)) criterion = std::move(here);
    }
  }
}

Criterion gougeOf(const ValidJob& job, const GroundTool* tool) {
  // Half of the core's tolerance, which is for a diameter; it holds for the whole flute.
  const double allowed = job->cutter.core_tolerance / 2;
  Criterion gouge{"gouge", "mm", true, 3, 0, allowed / kMillimetre, {}, false, "", ""};
  if (tool == nullptr) return gouge;
  add(gouge, 0, "");
  const auto passOf = [](const Gouge& found) { return placeOf(found.place) + ", " + toString(found.move); };
  const Gouge* worst = nullptr;
  for (const Gouge& found : tool->gouges) {
    add(gouge, found.depth / kMillimetre, passOf(found) + ", " + placeAt(found.x));
    if (worst == nullptr || found.depth > worst->depth) worst = &found;
  }
  const char* also = "; also ";
  for (const Gouge& found : tool->gouges) {
    if (&found == worst || !(found.depth > allowed)) continue;
    gouge.place += std::exchange(also, "; ") + passOf(found);
  }
  return gouge;
}

Criterion deviationOf(const RunFacts& run) {
  const double asked = run.job->interpolation.tolerance / kMicrometre;
  Criterion deviation{"path deviation", "\u00b5m", false, {}, 0, asked, {}, false, "", ""};
  for (const StrokeFigures& stroke : run.strokes) {
    add(deviation, stroke.deviation / kMicrometre, placeOf(stroke.place) + ", " + placeAt(stroke.deviation_x));
  }
  return deviation;
}

double maxRadius(const CutterGeometry& geometry) {
  const ConicalCutter cutter(geometry);
  return std::max(cutter.radius(0), cutter.radius(geometry.flute_length));
}

Criterion followingErrorOf(const RunFacts& run) {
  Criterion following{kFollowing, "\u00b5m", false, 2, 0, 0, {}, false, "", ""};
  const double radius = maxRadius(run.job->cutter);
  for (const StrokeFigures& stroke : run.strokes) {
    for (int axis = 0; axis < kAxisCount; ++axis) {
      const double error = stroke.following_error[axis] * (axis == kA ? radius : 1);
      add(following, error / kMicrometre, axisName(axis) + ", " + placeOf(stroke.place));
    }
  }
  return following;
}

/// The limit that slows the plan down within the flute; null if there is none.
const FeedLimit* slowedWithin(double flute_length, const std::vector<FeedLimit>& limits) {
  const auto found = std::find_if(limits.begin(), limits.end(), [&](const FeedLimit& limit) {
    const auto [low, high] = std::minmax(limit.from_x, limit.to_x);
    return low < flute_length && high > 0;
  });
  return found == limits.end() ? nullptr : &*found;
}

Criterion feedOf(const RunFacts& run) {
  const double asked = run.job->process().feed / kMillimetrePerMinute;
  Criterion feed{kFeed, "mm/min", false, 1, asked, 0, {}, false, "", ""};
  if (const FeedLimit* slowed = slowedWithin(run.job->cutter.flute_length, run.feed_limits)) {
    feed.remark = "the plan slows down: " + slowed->cause +
                  format(", X %.3f to %.3f mm", slowed->from_x / kMillimetre, slowed->to_x / kMillimetre);
    return feed;
  }
  for (const StrokeFigures& stroke : run.strokes) {
    if (!stroke.has_feed) continue;
    add(feed, stroke.min_feed / kMillimetrePerMinute, placeOf(stroke.place) + ", " + placeAt(stroke.min_feed_x));
    add(feed, stroke.max_feed / kMillimetrePerMinute, placeOf(stroke.place));
  }
  return feed;
}

Criterion lateCyclesOf(const RunFacts& run) {
  Criterion late{kLate, "%", false, 3, 0, 0, {}, false, "", ""};
  if (run.cycles == 0) return late;
  std::string place = format("%ju of %ju cycles", std::uintmax_t{run.late}, std::uintmax_t{run.cycles});
  if (run.longest > 0) place += format(", the longest %.3f ms", run.longest * 1e3);
  add(late, 100 * static_cast<double>(run.late) / static_cast<double>(run.cycles), place);
  return late;
}

/// Calls `visit(key, member)` for each field of a criterion in a file.
template <typename AnyCriterion, typename Visit>
void visitCriterion(AnyCriterion& criterion, const Visit& visit) {
  visit("name", criterion.name);
  visit("unit", criterion.unit);
  visit("of_tool", criterion.of_tool);
  visit("digits", criterion.digits);
  visit("asked", criterion.asked);
  visit("measured", criterion.measured);
  visit("tolerance", criterion.tolerance);
  visit("missing", criterion.missing);
  visit("place", criterion.place);
  visit("remark", criterion.remark);
}

template <typename T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
template <typename T>
Json orNull(const T& value) {
  return value;
}

template <typename T>
void take(const Json& json, std::optional<T>& value) {
  value = json.is_null() ? std::nullopt : std::optional<T>(json.get<T>());
}
template <typename T>
void take(const Json& json, T& value) {
  json.get_to(value);
}

/// Whether a figure of an end is one of a tooth as a whole, and not of a place on its edge.
bool isOfTooth(ToolFigure figure) {
  switch (figure) {
    case ToolFigure::kUncutDiameter:
    case ToolFigure::kShortFrom:
    case ToolFigure::kPeripheryTaken:
    case ToolFigure::kChamferWidth:
    case ToolFigure::kChamferAngle:
    case ToolFigure::kChamferClearance: return true;
    default: return false;
  }
}

std::string placeOnEnd(ToolFigure figure, const GroundFigure::At& at) {
  const std::string tooth = format("tooth %d", at.tooth + 1);
  return isOfTooth(figure) ? tooth : tooth + format(", %.3f mm from the axis", at.x / kMillimetre);
}

/// The criteria of an end: each figure's value that is farther from the asked one.
void addCriteriaOfEnd(const ValidJob& job, const GroundTool* tool, std::vector<Criterion>& criteria) {
  for (const GroundFigure& asks : askedOfEnd(job)) {
    const ToolFigureRow& row = rowOf(asks.figure);
    const double scale = shopScale(row.unit);
    Criterion& criterion = criteria.emplace_back(criterionOf(row, asks.asked->from, asks.tolerance));
    if (tool == nullptr || !tool->allTeethGround()) continue;
    const GroundFigure* found = find(tool->check.figures, asks.figure);
    if (found == nullptr) {
      add(criterion, std::nullopt, "");
      continue;
    }
    for (const GroundFigure::At& at : {found->least, found->largest}) {
      add(criterion, at.value / scale, placeOnEnd(asks.figure, at));
    }
  }
}

}  // namespace

const char* Criterion::result() const {
  if (!isMeasured(*this)) return "not measured";
  return excess(*this) <= 0 ? "passed" : "failed";
}

Tolerances readTolerances(const std::string& path) {
  Tolerances tolerances;
  FlatFile file(readTextFile(path), path, "file of tolerances", "its tolerances");
  const std::string allowed = "a number from 0";
  for (const ToleranceRow& row : kTolerances) {
    double& value = tolerances.*row.value;
    if (file.take(row.key, allowed, value) && !(value >= 0 && value < kInfinity)) {
      file.fail(file.line(row.key), std::string(row.key) + format(" = %g; allowed: ", value) + allowed);
    }
  }
  file.refuseTheRest();
  file.throwErrors();
  return tolerances;
}

std::vector<Criterion> criteriaOfTool(const ValidJob& job, const GroundTool* tool, const Tolerances& tolerances) {
  GroundSection small_end;
  small_end.radius = job->cutter.end_diameter / 2;
  small_end.teeth.resize(1);
  std::vector<Criterion> criteria;
  for (const ToolFigureRow& row : kToolFigures) {
    const FigurePlace first{job, small_end, 0};
    if (!isJudged(row, first)) continue;
    Criterion& criterion = criteria.emplace_back(criterionOf(row, first, tolerances));
    // What is taken from the plan was not measured.
    const bool is_measured =
        tool != nullptr && tool->allTeethGround() && !(tool->on_planned && row.of != rowOf(job->process().kind).form);
    if (is_measured) addFigure(criterion, row, *tool, tolerances);
  }
  if (job.isStraight()) addCriteriaOfEnd(job, tool, criteria);
  criteria.push_back(gougeOf(job, tool));
  return criteria;
}

std::vector<Criterion> criteriaOfRun(const RunFacts& run, const Tolerances& tolerances) {
  std::vector<Criterion> criteria;
  if (!run.job.isStraight()) criteria.push_back(deviationOf(run));  // straight strokes have no deviation
  for (Criterion& criterion : std::vector{followingErrorOf(run), feedOf(run), lateCyclesOf(run)}) {
    criteria.push_back(std::move(criterion));
  }
  judgeAgain(criteria, tolerances);
  return criteria;
}

void judgeAgain(std::vector<Criterion>& criteria, const Tolerances& tolerances) {
  for (Criterion& criterion : criteria) setTolerance(criterion, tolerances);
}

Verdict verdictOn(const std::vector<Criterion>& criteria, const std::string& outcome, std::uint64_t lost,
                  std::vector<std::string> unknown) {
  std::vector<std::string> failed;
  if (outcome.empty()) unknown.emplace_back("the end of the job is not in the file");
  if (!outcome.empty() && outcome != "done") failed.push_back("the job ended as " + outcome);
  for (const Criterion& criterion : criteria) {
    if (!isMeasured(criterion)) unknown.push_back(criterion.name + ": not measured");
    if (isMeasured(criterion) && !(excess(criterion) <= 0)) failed.push_back(criterion.name);
  }
  if (!failed.empty()) return {"failed", failed};
  if (lost > 0) unknown.push_back(format("%ju setpoints are not in the file", std::uintmax_t{lost}));
  if (outcome.empty()) return {"unfinished", unknown};
  return {unknown.empty() ? "passed" : "incomplete", unknown};
}

Json toJson(const std::vector<Criterion>& criteria) {
  Json list = Json::array();
  for (const Criterion& criterion : criteria) {
    Json& json = list.emplace_back(Json::object());
    visitCriterion(criterion, [&](const char* key, const auto& value) { json[key] = orNull(value); });
    json["result"] = criterion.result();
  }
  return list;
}

std::vector<Criterion> criteriaFrom(const Json& json) {
  std::vector<Criterion> criteria;
  for (const Json& entry : json) {
    visitCriterion(criteria.emplace_back(), [&](const char* key, auto& value) { take(entry.at(key), value); });
  }
  return criteria;
}

}  // namespace grinder
