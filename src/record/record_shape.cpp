#include "record/record_shape.h"

#include "flute_grinder/record/record_file.h"

#include <stdexcept>
#include <string>

namespace grinder {

namespace {

/// What a record has: objects by their keys, of which one that ends in ? may be missing; lists by what each element is;
/// and of a value its type, of which one that ends in ? may be null. What is not here may be anything.
constexpr const char* kShape = R"({
  "record": "count", "grinder?": "text",
  "machine": {"name?": "text", "software": "text", "drive?": "text", "period_ms": "number"},
  "job": {"name": "text", "digest?": "text", "file": {
    "cutter": {"end_diameter_mm": "number", "cone_angle_deg": "number", "flute_length_mm": "number", "rake_angle_deg": "number",
      "rake_tolerance_deg": "number", "chordal_rake_tolerance_deg": "number", "spiral_tolerance_deg": "number",
      "core_tolerance_mm": "number", "spiral_angle_deg?": "number", "spiral_angles_deg?": ["number"], "teeth?": "count",
      "tooth_angles_deg?": ["number"], "clearance_deg?": "number", "clearance_tolerance_deg?": "number", "land_mm?": "number"},
    "process": {"feed_mm_min": "number", "incomplete_ok?": "flag"},
    "interpolation": {"tolerance_um": "number"}, "operation?": "text"}},
  "started": "time", "ended": "time", "outcome": "text", "reason": "text",
  "wheel": {"name": "text", "dressed": "text"}, "passes": "count",
  "planned?": {"feed_limits": [{"cause": "text", "from_x_mm": "number", "to_x_mm": "number"}]},
  "setpoints": {"written": "count", "lost": "count"}, "late_cycles": {"count": "count", "longest_ms": "number?"}
})";

/// What only a whole record has.
constexpr const char* kWholeShape = R"({
  "machine": {"max_velocity?": {}, "max_acceleration?": {}, "max_following_error?": {}},
  "work_offsets?": {"x_mm": "number", "y_mm": "number", "z_mm": "number", "a_deg": "number"},
  "strokes": [{"tooth": "count", "pass": "count", "depth_mm": "number?", "started_s": "number", "duration_s": "number",
    "feed_min_mm_min": "number?", "feed_min_x_mm": "number?", "feed_max_mm_min": "number?", "deviation_um": "number?",
    "deviation_x_mm?": "number?", "complete": "flag",
    "following_error": {"x_um": "number?", "y_um": "number?", "z_um": "number?", "a_mdeg": "number?"}}],
  "holds": [{"at_s": "number", "duration_s": "number", "reason": "text"}],
  "overrides": [{"at_s": "number", "percent": "number"}]
})";

constexpr const char* kSummaryShape = R"({"complete_strokes": "count", "holds": "count"})";

bool isTime(const Json& value) {
  if (!value.is_string()) return false;
  try {
    timeOf(value);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

bool isOfType(const Json& value, const std::string& type) {
  if (type == "time") return isTime(value);
  if (type == "text") return value.is_string();
  if (type == "flag") return value.is_boolean();
  if (type == "count") return value.is_number_unsigned();
  return value.is_number();
}

std::string wordsOf(const Json& shape) {
  if (shape.is_object()) return "an object";
  if (shape.is_array()) return "a list";
  std::string type = shape;
  const bool or_null = type.back() == '?';
  if (or_null) type.pop_back();
  const std::string words = type == "time"    ? "a time, as 2026-11-22T17:04:13.123Z"
                            : type == "flag"  ? "true or false"
                            : type == "count" ? "a whole number from 0"
                                              : "a " + type;
  return words + (or_null ? ", or null" : "");
}

[[noreturn]] void refuse(const std::string& key, const Json& value, const Json& shape) {
  constexpr std::size_t most = 60;
  std::string shown = text(value, -1);
  if (shown.size() > most) shown.replace(most, std::string::npos, "...");
  throw std::invalid_argument(key + " = " + shown + "; allowed: " + wordsOf(shape));
}

void checkValue(const Json& value, const Json& shape, const std::string& key);

void checkObject(const Json& object, const Json& shape, const std::string& path) {
  if (!object.is_object()) refuse(path, object, shape);
  for (const auto& [name, member] : shape.items()) {
    const bool optional = name.back() == '?';
    const std::string key = optional ? name.substr(0, name.size() - 1) : name;
    const std::string at = (path.empty() ? "" : path + ".") + key;
    if (object.contains(key)) {
      checkValue(object.at(key), member, at);
    } else if (!optional) {
      throw std::invalid_argument(at + " is missing");
    }
  }
}

void checkValue(const Json& value, const Json& shape, const std::string& key) {
  if (shape.is_object()) return checkObject(value, shape, key);
  if (shape.is_array()) {
    if (!value.is_array()) refuse(key, value, shape);
    for (std::size_t i = 0; i < value.size(); ++i) {
      checkValue(value[i], shape[0], key + '[' + std::to_string(i) + ']');
    }
    return;
  }
  std::string type = shape;
  const bool or_null = type.back() == '?';
  if (or_null) type.pop_back();
  if (!(or_null && value.is_null()) && !isOfType(value, type)) refuse(key, value, shape);
}

}  // namespace

void checkRecord(Json& record, bool summary) {
  static const Json both = Json::parse(kShape), whole = Json::parse(kWholeShape), in_short = Json::parse(kSummaryShape);
  checkObject(record, both, "");
  checkObject(record, summary ? in_short : whole, "");
  escapeTexts(record);
}

}  // namespace grinder
