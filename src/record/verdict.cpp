#include "flute_grinder/record/verdict.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/job/format.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/record/record_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace grinder {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct ToleranceRow {
  const char* key;
  double Tolerances::*value;
};
constexpr ToleranceRow kTolerances[]{{"land_mm", &Tolerances::land_mm},
                                     {"primary_mm", &Tolerances::primary_mm},
                                     {"following_error_um", &Tolerances::following_error_um},
                                     {"feed_percent", &Tolerances::feed_percent},
                                     {"late_cycles_percent", &Tolerances::late_cycles_percent}};

std::string toleranceKeys() {
  std::string keys;
  for (const ToleranceRow& row : kTolerances) keys += (keys.empty() ? "" : ", ") + std::string(row.key);
  return keys;
}

/// One line of the verdict, all in `unit`.
class Criterion {
 public:
  /// @param digits behind the point; nothing: three in all. @param asked nothing if it comes with each value.
  /// @param tolerance maximum difference from what is asked; nothing: `asked` is the minimum allowed.
  Criterion(std::string name, std::string unit, std::optional<int> digits, std::optional<double> asked,
            std::optional<double> tolerance)
      : name_(std::move(name)), unit_(std::move(unit)), digits_(digits), asked_(asked), tolerance_(tolerance) {}

  /// A measured value; the one that is farthest off remains. @param value nothing: there is nothing to measure where
  /// there should be.
  void add(std::optional<double> value, std::string place, std::optional<double> asked = std::nullopt);
  void setRemark(std::string remark) { remark_ = std::move(remark); }
  void addToPlace(const std::string& text) { place_ += text; }

  const std::string& name() const { return name_; }
  const std::string& place() const { return place_; }
  std::string_view result() const;
  Json json() const;

 private:
  double distance(std::optional<double> value, std::optional<double> asked) const;

  std::string name_, unit_;
  std::optional<int> digits_;
  std::optional<double> asked_, tolerance_, measured_;
  std::optional<double> worst_;  ///< distance
  std::string place_, remark_;
};

/// Of a value from what is asked; what cannot be compared is infinitely far off.
double Criterion::distance(std::optional<double> value, std::optional<double> asked) const {
  if (!value || !asked) return kInfinity;
  const double off = tolerance_ ? std::abs(*value - *asked) : *asked - *value;
  return std::isnan(off) ? kInfinity : off;
}

void Criterion::add(std::optional<double> value, std::string place, std::optional<double> asked) {
  if (!asked) asked = asked_;
  const double off = distance(value, asked);
  if (worst_ && off <= *worst_) return;
  worst_ = off;
  asked_ = asked;
  measured_ = value;
  place_ = std::move(place);
  remark_ = value ? "" : "there is none";
}

std::string_view Criterion::result() const {
  if (!worst_) return "not measured";
  return *worst_ <= tolerance_.value_or(0) ? "passed" : "failed";
}

template <typename T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json Criterion::json() const {
  return {{"name", name_},
          {"unit", unit_},
          {"digits", orNull(digits_)},
          {"asked", orNull(asked_)},
          {"measured", orNull(measured_)},
          {"tolerance", orNull(tolerance_)},
          {"place", place_},
          {"result", std::string(result())},
          {"remark", remark_}};
}

/// What an object has under a key; null if it lacks it.
const Json& find(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

/// Nothing for null, and for NaN, which a file would have as null.
std::optional<double> number(const Json& json) {
  if (json.is_null()) return std::nullopt;
  const double value = json.get<double>();
  return std::isnan(value) ? std::nullopt : std::optional<double>(value);
}

std::string placeAt(double x_mm) { return format("X = %.3f mm", x_mm); }

/// @param x_mm nothing for the whole stroke.
std::string placeOf(const Json& stroke, std::optional<double> x_mm = std::nullopt) {
  const std::string place = format("tooth %d, pass %d", stroke.at("tooth").get<int>(), stroke.at("pass").get<int>());
  return x_mm ? place + ", " + placeAt(*x_mm) : place;
}

std::string passOf(const Json& gouge) {
  return format("tooth %d, pass %d, ", gouge.at("tooth").get<int>() + 1, gouge.at("pass").get<int>() + 1) +
         gouge.at("move").get<std::string>();
}

Criterion deviationOf(const Json& job, const Json& strokes) {
  Criterion deviation("path deviation", "\u00b5m", std::nullopt, 0, number(job.at("interpolation").at("tolerance_um")));
  for (const Json& stroke : strokes) {
    const auto value = number(stroke.at("deviation_um"));
    if (value) deviation.add(value, placeOf(stroke, number(find(stroke, "deviation_x_mm"))));
  }
  return deviation;
}

double maxRadius(const Json& cutter) {
  const double end = cutter.at("end_diameter_mm").get<double>() / 2;
  const double cone = std::tan(cutter.at("cone_angle_deg").get<double>() * units::kDegree);
  return std::max(end, end + cutter.at("flute_length_mm").get<double>() * cone);
}

Criterion followingErrorOf(const Json& job, const Json& strokes, const Tolerances& tolerances) {
  Criterion following("following error in strokes", "\u00b5m", 2, 0, tolerances.following_error_um);
  const double radius = maxRadius(job.at("cutter"));
  for (const Json& stroke : strokes) {
    for (const auto& axis : find(stroke, "following_error").items()) {
      auto value = number(axis.value());
      if (!value) continue;  // a faulty drive read NaN
      // Of A in thousandths of a degree, here thousandths of a millimetre at the surface.
      if (axis.key() == "a_mdeg") value = *value * units::kDegree * radius;
      const char name = static_cast<char>(std::toupper(static_cast<unsigned char>(axis.key()[0])));
      following.add(value, std::string(1, name) + ", " + placeOf(stroke));
    }
  }
  return following;
}

/// Where the plan itself slows down within the flute; null if it does not.
const Json& slowedWithin(double flute_length_mm, const Json& feed_limits) {
  static const Json nowhere;
  for (const Json& limit : feed_limits) {
    const auto [low, high] = std::minmax({limit.at("from_x_mm").get<double>(), limit.at("to_x_mm").get<double>()});
    if (low < flute_length_mm && high > 0) return limit;
  }
  return nowhere;
}

Criterion feedOf(const Json& job, const Json& strokes, const Json& feed_limits, const Tolerances& tolerances) {
  const double asked = job.at("process").at("feed_mm_min");
  Criterion feed("feed constancy", "mm/min", 1, asked, asked * tolerances.feed_percent / 100);
  const Json& slowed = slowedWithin(job.at("cutter").at("flute_length_mm"), feed_limits);
  if (!slowed.is_null()) {
    feed.setRemark(
        "the plan slows down: " + slowed.at("cause").get<std::string>() +
        format(", X %.3f to %.3f mm", slowed.at("from_x_mm").get<double>(), slowed.at("to_x_mm").get<double>()));
    return feed;
  }
  for (const Json& stroke : strokes) {
    const auto min = number(stroke.at("feed_min_mm_min"));
    if (!min) continue;
    feed.add(min, placeOf(stroke, number(find(stroke, "feed_min_x_mm"))));
    feed.add(number(stroke.at("feed_max_mm_min")), placeOf(stroke));
  }
  return feed;
}

/// Calls `visit(section, tooth, place)` for every tooth in every section of a tool; null has none.
template <typename Visit>
void forEachTooth(const Json& tool, const Visit& visit) {
  for (const Json& section : find(tool, "sections")) {
    int number = 0;
    for (const Json& tooth : section.at("teeth")) {
      visit(section, tooth, format("tooth %d, ", ++number) + placeAt(section.at("x_mm")));
    }
  }
}

/// @param tool with flutes as ground; null if they were not measured.
std::vector<Criterion> ofFlutes(const Json& job, const Json& tool, const Tolerances& tolerances) {
  const Json& cutter = job.at("cutter");
  const auto asked_rake = number(cutter.at("rake_angle_deg"));
  Criterion rake("rake", "deg", 3, asked_rake, number(cutter.at("rake_tolerance_deg")));
  Criterion chord("chordal rake", "deg", 3, asked_rake, number(cutter.at("chordal_rake_tolerance_deg")));
  Criterion core("core diameter", "mm", 3, std::nullopt, number(cutter.at("core_tolerance_mm")));
  Criterion land("land", "mm", 3, tolerances.land_mm, std::nullopt);
  Criterion spiral("spiral angle", "deg", 3, std::nullopt, number(cutter.at("spiral_tolerance_deg")));
  const bool incomplete_ok = job.at("process").value("incomplete_ok", false);
  for (const Json& section : find(tool, "sections")) {
    core.add(number(section.at("core_diameter_mm")), placeAt(section.at("x_mm")),
             number(section.at("asked_core_diameter_mm")));
  }
  forEachTooth(tool, [&](const Json&, const Json& tooth, const std::string& place) {
    // A job may allow an incomplete flute, which has no rake face at its end.
    if (tooth.at("complete").get<bool>() || !incomplete_ok) {
      rake.add(number(tooth.at("rake_deg")), place);
      chord.add(number(tooth.at("chordal_rake_deg")), place);
    }
    land.add(number(tooth.at("land_mm")), place);
    spiral.add(number(tooth.at("spiral_deg")), place, number(tooth.at("asked_spiral_deg")));
  });
  return {rake, chord, core, land, spiral};
}

/// The operation of a job, "flute" for one alone.
std::string operationOf(const Json& job) { return job.value("operation", toString(OperationKind::kFlute)); }

/// @param tool as ground; null if it was not measured.
std::vector<Criterion> ofReliefs(const Json& job, const Json& tool, const Tolerances& tolerances) {
  const std::string operation = operationOf(job);
  if (operation == toString(OperationKind::kFlute)) return {};
  const Json& cutter = job.at("cutter");
  std::vector<Criterion> criteria;
  const auto addClearance = [&](const char* name, const char* key) {
    Criterion& clearance =
        criteria.emplace_back(name, "deg", 3, number(cutter.at(key)), number(cutter.at("clearance_tolerance_deg")));
    forEachTooth(tool, [&](const Json&, const Json& tooth, const std::string& place) {
      clearance.add(number(tooth.at(key)), place);
    });
  };
  addClearance("clearance", "clearance_deg");
  // A primary relief is as wide as asked once a secondary one ends it.
  if (operation != toString(OperationKind::kSecondaryRelief)) return criteria;
  addClearance("second clearance", "second_clearance_deg");
  Criterion& primary =
      criteria.emplace_back("primary relief", "mm", 3, number(cutter.at("land_mm")), tolerances.primary_mm);
  forEachTooth(tool, [&](const Json& section, const Json& tooth, const std::string& place) {
    if (section.at("x_mm") == 0) primary.add(number(tooth.at("primary_mm")), place);
  });
  return criteria;
}

/// @param tool of a record, as far as it was ground; null if it was not measured.
Criterion gougeOf(const Json& job, const Json& tool) {
  // The core's tolerance, which is of a diameter, holds for the whole flute.
  const double tolerance = job.at("cutter").at("core_tolerance_mm").get<double>() / 2;
  Criterion gouge("gouge", "mm", 3, 0, tolerance);
  const Json& gouges = find(tool, "gouges");
  if (gouges.is_null()) return gouge;
  gouge.add(0, "");
  for (const Json& found : gouges) {
    gouge.add(number(found.at("depth_mm")), passOf(found) + ", " + placeAt(found.at("x_mm")));
  }
  std::string others;
  for (const Json& found : gouges) {
    const std::string pass = passOf(found);
    const bool is_worst = gouge.place().compare(0, pass.size(), pass) == 0;
    if (is_worst || number(found.at("depth_mm")).value_or(kInfinity) <= tolerance) continue;
    others += "; " + std::string(others.empty() ? "also " : "") + pass;
  }
  gouge.addToPlace(others);
  return gouge;
}

bool isOwnRecord(const Json& data) { return data.at("kind") == "record"; }

/// Control cycles in which late ones were counted: in a record of the grinder also those in which the job was held.
long long cyclesOf(const Json& data) {
  if (isOwnRecord(data)) {
    return std::llrint(1000 * data.at("duration_s").get<double>() / data.at("machine").at("period_ms").get<double>());
  }
  const Json& written = find(find(data, "setpoints"), "written");
  return written.is_null() ? 0 : written.get<long long>();
}

Criterion lateCyclesOf(const Json& data, const Tolerances& tolerances) {
  Criterion late("late cycles", "%", 3, 0, tolerances.late_cycles_percent);
  const Json& found = find(data, "late_cycles");
  const long long cycles = cyclesOf(data);
  if (found.is_null() || cycles == 0) return late;
  const auto count = found.at("count").get<long long>();
  const double longest = number(found.at("longest_ms")).value_or(0);
  late.add(100 * static_cast<double>(count) / static_cast<double>(cycles),
           format("%lld of %lld cycles", count, cycles) +
               (longest != 0 ? format(", the longest %.3f ms", longest) : std::string()));
  return late;
}

/// The lines of the verdict, in the order of the report.
std::vector<Criterion> criteriaOf(const Json& data, const Tolerances& tolerances) {
  const Json& job = data.at("job").at("file");
  const Json& strokes = data.at("strokes");
  const Json none;
  // A record of the grinder has no positions of which a tool could be computed: its tool is the one that the job asks
  // for.
  const Json& recorded = isOwnRecord(data) ? none : find(data, "tool");
  const Json& ground = !recorded.is_null() && allTeethGround(recorded) ? recorded : none;
  const Json& flutes = find(ground, "on_planned") == true ? none : ground;
  std::vector<Criterion> list = ofFlutes(job, flutes, tolerances);
  list.insert(list.begin(), deviationOf(job, strokes));
  for (Criterion& criterion : ofReliefs(job, ground, tolerances)) list.push_back(std::move(criterion));
  list.push_back(gougeOf(job, recorded));
  list.push_back(followingErrorOf(job, strokes, tolerances));
  list.push_back(feedOf(job, strokes, find(find(data, "planned"), "feed_limits"), tolerances));
  list.push_back(lateCyclesOf(data, tolerances));
  return list;
}

/// The names of the criteria that have a result, each with an end.
std::vector<std::string> criteriaThat(const std::vector<Criterion>& criteria, const char* result, const char* end) {
  std::vector<std::string> names;
  for (const Criterion& criterion : criteria) {
    if (criterion.result() == result) names.push_back(criterion.name() + end);
  }
  return names;
}

Verdict verdictOf(const Json& data, const std::vector<Criterion>& criteria) {
  const Json& outcome = find(data, "outcome");
  std::vector<std::string> failed = criteriaThat(criteria, "failed", "");
  if (!outcome.is_null() && outcome != "done") {
    failed.insert(failed.begin(), "the job ended as " + outcome.get<std::string>());
  }
  if (!failed.empty()) return {"failed", failed};
  std::vector<std::string> unknown = criteriaThat(criteria, "not measured", ": not measured");
  if (outcome.is_null()) {
    unknown.insert(unknown.begin(), "the end of the job is not in the file");
    return {"unfinished", unknown};
  }
  const Json& lost = find(find(data, "setpoints"), "lost");
  if (!lost.is_null() && lost != 0) {
    unknown.insert(unknown.begin(), format("%lld setpoints are not in the file", lost.get<long long>()));
  }
  return {unknown.empty() ? "passed" : "incomplete", unknown};
}

/// Adds to a record that the grinder keeps what a verdict needs beside its keys.
void completeRecord(Json& record) {
  record["kind"] = "record";
  // The times are in whole milliseconds.
  record["duration_s"] = std::round(1000 * (timeOf(record.at("ended")) - timeOf(record.at("started")))) / 1000;
}

}  // namespace

bool allTeethGround(const Json& tool) {
  std::set<int> teeth;
  for (const Json& stroke : tool.at("strokes")) teeth.insert(stroke.at("tooth").get<int>());
  return teeth.size() == tool.at("teeth").get<std::size_t>();
}

Tolerances readTolerances(const std::string& path) {
  const auto refuse = [&](const std::string& why) { throw JobFileError(path + ": " + why); };
  const YAML::Node root = parseYaml(readTextFile(path), path);
  if (!root.IsMap()) refuse("has no keys; allowed: " + toleranceKeys());
  Tolerances tolerances;
  std::set<std::string> given;
  for (const auto& item : root) {
    const std::string key = item.first.IsScalar() ? item.first.Scalar() : "(not a word)";
    const auto row = std::find_if(std::begin(kTolerances), std::end(kTolerances),
                                  [&](const ToleranceRow& r) { return r.key == key; });
    if (row == std::end(kTolerances)) refuse(key + ": not known; allowed: " + toleranceKeys());
    double& value = tolerances.*row->value;
    if (!readValue(item.second, value).empty() || !(value >= 0 && value < kInfinity)) {
      refuse(key + " = " + (item.second.IsScalar() ? item.second.Scalar() : "(not a value)") +
             "; allowed: a number from 0");
    }
    given.insert(key);
  }
  for (const ToleranceRow& row : kTolerances) {
    if (given.count(row.key) == 0) refuse(std::string(row.key) + " is missing");
  }
  return tolerances;
}

void addVerdict(Json& data, const Tolerances& tolerances) {
  const std::vector<Criterion> criteria = criteriaOf(data, tolerances);
  Json list = Json::array();
  for (const Criterion& criterion : criteria) list.push_back(criterion.json());
  const Verdict verdict = verdictOf(data, criteria);
  data["criteria"] = list;
  data["verdict"] = verdict.verdict;
  data["verdict_because"] = verdict.because;
}

void judgeRecord(Json& record, const Tolerances& tolerances) {
  completeRecord(record);
  addVerdict(record, tolerances);
}

Verdict verdictOnRecord(Json& record, const Tolerances& tolerances) {
  completeRecord(record);
  return verdictOf(record, criteriaOf(record, tolerances));
}

}  // namespace grinder
