#include "flute_grinder/job/wheel_file.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/flat_file.h"
#include "flute_grinder/job/job_fields.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace grinder {

namespace {

using units::kMillimetre;

constexpr const char* kDate = "measured.date";
constexpr const char* kDiameter = "measured.diameter_mm";
constexpr const char* kWidth = "measured.width_mm";
constexpr const char* kBy = "measured.by";
constexpr const char* kDressed = "dressed";
constexpr const char* kDates = "YYYY-MM-DD, YYYY-MM-DDThh:mm:ssZ";
constexpr const char* kText = "a text";
constexpr JobField kFlange{
    "flange",     "flange_mm",
    Unit::kMetre, -100,
    100,          "from the face of the flange along the spindle down to the wheel's upper face, for `grind zeros`",
    "not known"};

/// The key in a wheel file of what a job says of its wheel; empty for all else, and for the wear, which is derived.
template <typename Field>
const char* wheelKey(const Field& field) {
  const std::string_view prefix = "process.wheel.", path = field.path;
  const bool here = std::string_view(field.file_key).substr(0, prefix.size()) == prefix &&
                    path != "process.wheel_file" && path.find("process.wheel_wear") != 0;
  return here ? field.file_key + prefix.size() : "";
}

/// The field of a wheel's number.
JobField fieldOf(std::string_view path) {
  JobField found{};
  visitJobFields([&](const JobField& field, auto) {
    if (field.path == path) found = field;
  });
  return found;
}

JobField measuredWidth() {
  JobField width = fieldOf("process.wheel_width");
  width.file_key = kWidth;
  width.meaning = "width as measured; with the profile `points`, the width of its points";
  width.omitted = "`width_mm`";
  return width;
}

void takeWheelPoints(FlatFile& file, const std::string& key, GrindJob& job) {
  const std::string& allowed = otherJobKey("process.wheel_points").allowed;
  if (!file.mentions(key)) return file.fail(1, key + " is missing; allowed: " + allowed);
  for (std::size_t i = 0; i == 0 || file.hasAny(element(key, i)); ++i) {
    std::vector<double> point;
    file.takeList(element(key, i), allowed, kMillimetre, point);
    if (point.size() != 2) return file.fail(file.line(key), element(key, i) + " is not a pair; allowed: " + allowed);
    job.process().wheel_points.push_back({point[0], point[1]});
  }
}

void takeFlange(FlatFile& file, WheelFile& wheel) {
  const std::string key = kFlange.file_key;
  const Quantity low = kFlange.low(), high = kFlange.high();
  const std::string allowed = text(low, high);
  double value = 0;
  if (!file.mayHave(key) || !file.take(key, allowed, value)) return;
  const Quantity flange{value * kMillimetre, Unit::kMetre};
  if (!(flange.si >= low.si && flange.si <= high.si)) {
    return file.fail(file.line(key), key + " = " + text(flange, 10) + "; allowed: " + allowed);
  }
  wheel.flange = flange.si;
}

/// Wear of the radius, rounded to a picometre, so that it is bit-identical to the same number of millimetres in a job
/// file.
double wearOf(double diameter, double measured) {
  constexpr double per_millimetre = 1e9;
  return std::round((diameter - measured) / 2 / kMillimetre * per_millimetre) / per_millimetre * kMillimetre;
}

void takeMeasuredDiameter(FlatFile& file, GrindProcess& process) {
  const JobField diameter = fieldOf("process.wheel_diameter");
  const JobField wear = fieldOf("process.wheel_wear");
  // A wrong diameter_mm is reported by itself.
  const bool set = process.wheel_diameter >= diameter.low().si && process.wheel_diameter <= diameter.high().si;
  const double max = set ? process.wheel_diameter : diameter.high().si;
  const double min = set ? std::max(diameter.low().si, max - 2 * wear.high().si) : diameter.low().si;
  const std::string allowed =
      text(Quantity{min, Unit::kMetre}, Quantity{max, Unit::kMetre}, 10) + ", the diameter to which Y = 0 is set";
  double value = 0;
  if (!file.take(kDiameter, allowed, value)) return;
  const double measured = value * kMillimetre;
  if (!(measured >= min && measured <= max)) {
    return file.fail(file.line(kDiameter), std::string(kDiameter) + " = " + text(Quantity{measured, Unit::kMetre}, 10) +
                                               "; allowed: " + allowed);
  }
  process.wheel_wear = wearOf(process.wheel_diameter, measured);
}

void takeDate(FlatFile& file, const std::string& key, std::string& date) {
  if (!file.take(key, kDates, date) || hasForm(date, "0000-00-00") || hasForm(date, "0000-00-00T00:00:00Z")) return;
  file.fail(file.line(key), key + " = " + date + "; allowed: " + kDates);
}

/// @param process receives the wear and the width.
void takeMeasurement(FlatFile& file, WheelFile& wheel, GrindProcess& process) {
  for (const char* key : {kDate, kDiameter, kWidth, kBy}) wheel.measured = wheel.measured || file.mentions(key);
  if (!wheel.measured) {
    for (const char* key : {kDate, kDiameter, kWidth, kBy}) file.know(key);
    return;
  }
  takeDate(file, kDate, wheel.date);
  takeMeasuredDiameter(file, process);
  double width = 0;
  const JobField field = measuredWidth();
  if (file.mayHave(kWidth) && file.take(kWidth, text(field.low(), field.high()), width)) {
    process.wheel_width = width * kMillimetre;
  }
  if (file.mayHave(kBy)) file.take(kBy, kText, wheel.by);
}

/// The key of a wrong number of the wheel, new or as measured.
std::string keyOf(const Reason& reason, bool measured) {
  if (reason.field == "process.wheel_width" && measured) return kWidth;
  if (reason.field == "process.wheel_points") return "points_mm";
  std::string key;
  visitJobFields([&](const JobField& field, auto) {
    if (field.path == reason.field) key = wheelKey(field);
  });
  return key;
}

/// @param measured whether the numbers are the measured wheel's.
void check(FlatFile& file, const GrindJob& job, bool measured) {
  for (Reason reason : validateWheel(job)) {
    reason.field = keyOf(reason, measured && file.mentions(kWidth));
    file.fail(file.line(reason.field), text(reason));
  }
  file.throwErrors();
}

}  // namespace

std::vector<JobField> wheelFields() {
  std::vector<JobField> fields;
  visitJobFields([&](JobField field, auto) {
    field.file_key = wheelKey(field);
    if (*field.file_key != '\0') fields.push_back(field);
  });
  fields.push_back(kFlange);
  fields.push_back(measuredWidth());
  return fields;
}

std::vector<OtherKey> otherWheelKeys() {
  std::vector<OtherKey> keys;
  for (OtherKey key : otherJobKeys()) {
    key.file_key = wheelKey(key);
    if (*key.file_key != '\0') keys.push_back(key);
  }
  const double farthest = 2 * fieldOf("process.wheel_wear").max;
  const std::string diameters = text(fieldOf("process.wheel_diameter").low()) + " to `diameter_mm`, and at most " +
                                text(Quantity{farthest * kMillimetre, Unit::kMetre}) + " less than it";
  keys.push_back(
      {kDate, kDate, kDates,
       "when the wheel was measured or dressed, in UTC; the four keys of `measured` may be left out together"});
  keys.push_back({kDiameter, kDiameter, diameters,
                  "maximum diameter as measured; half of what it is below `diameter_mm` is the wear"});
  keys.push_back({kBy, kBy, kText, "who measured", "nothing"});
  keys.push_back({kDressed, kDressed, kDates, "when the wheel was dressed last, in UTC; for the records of its jobs",
                  "not known"});
  return keys;
}

void takeWheelShape(FlatFile& file, const std::string& prefix, GrindJob& job) {
  // An unknown profile may have a side.
  if (!file.takeChoice(prefix + "profile", job.process().wheel_profile)) return file.drop(prefix + "side");
  if (isTapered(job.process().wheel_profile)) file.takeChoice(prefix + "side", job.process().wheel_side);
  if (job.process().wheel_profile == WheelShape::kPoints) takeWheelPoints(file, prefix + "points_mm", job);
}

WheelFile parseWheel(const std::string& text, const std::string& name) {
  FlatFile file(text, name, "wheel file", "a wheel's keys");
  WheelFile wheel;
  GrindJob job;
  visitJobFields([&](const JobField& field, auto of) {
    const std::string key = wheelKey(field);
    double value = 0;
    if (key.empty()) return;
    if (field.omitted != nullptr && !file.mentionsPart(key)) return file.know(key);
    file.take(key, grinder::text(field.low(), field.high()), value);
    of(job) = value * shopScale(field.unit);
  });
  takeWheelShape(file, "", job);
  takeFlange(file, wheel);
  wheel.new_width = job.process().wheel_width;
  GrindJob now = job;
  takeMeasurement(file, wheel, now.process());
  if (file.mayHave(kDressed)) takeDate(file, kDressed, wheel.dressed);
  file.refuseTheRest();
  file.throwErrors();
  check(file, job, false);
  check(file, now, true);
  wheel.process = now.process();
  return wheel;
}

WheelFile readWheelFile(const std::string& path) { return parseWheel(readTextFile(path), path); }

void mountWheel(const WheelFile& wheel, GrindJob& job) {
  GrindJob from;
  from.process() = wheel.process;
  visitJobFields([&](const JobField& field, auto of) {
    if (*wheelKey(field) != '\0') of(job) = of(from);
  });
  job.process().wheel_wear = wheel.process.wheel_wear;
  job.process().wheel_profile = wheel.process.wheel_profile;
  job.process().wheel_side = wheel.process.wheel_side;
  job.process().wheel_points = wheel.process.wheel_points;
}

}  // namespace grinder
