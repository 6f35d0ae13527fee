#include "flute_grinder/core/grind_job.h"

#include "flute_grinder/core/job_fields.h"
#include "flute_grinder/core/units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flute_grinder {

namespace {

using core::ReasonKind;

/// Tolerance for the rounding of a unit conversion at the ends of a range.
constexpr double kRangeRounding = 1e-12;

/// Collects the errors in a job.
class Checker {
 public:
  void range(const JobField& f, double value) {
    const double min = f.low().si;
    const double max = f.high().si;
    if (!(value >= min - kRangeRounding * std::abs(min) && value <= max + kRangeRounding * std::abs(max))) {
      refuse(ReasonKind::kOutOfRange, f.path, {value, f.unit}, "", max, min);
    }
  }

  /// A count or choice must be from `min` to `max`.
  void whole(const char* path, int value, int max, int min = 0) {
    const Quantity count{static_cast<double>(value), Unit::kNone};
    if (!(value >= min && value <= max)) refuse(ReasonKind::kOutOfRange, path, count, "", max, min);
  }

  /// A length must be less than `limit`; `why` describes the limit.
  void below(const char* path, double value, double limit, const char* why) {
    if (!(value < limit)) refuse(ReasonKind::kNotBelow, path, {value, Unit::kMetre}, why, limit);
  }

  void refuse(ReasonKind kind, const char* path, const Quantity& value, const std::string& detail, double limit = 0,
              double low = 0) {
    core::Reason reason;
    reason.kind = kind;
    reason.field = path;
    reason.detail = detail;
    reason.unit = value.unit;
    reason.value = value.si;
    reason.low = low;
    reason.limit = limit;
    reasons_.push_back(std::move(reason));
  }

  bool good() const { return reasons_.empty(); }
  std::vector<core::Reason> take() { return std::move(reasons_); }

 private:
  std::vector<core::Reason> reasons_;
};

void checkTeeth(Checker& checker, const std::vector<double>& angles) {
  checker.whole("cutter.teeth", static_cast<int>(angles.size()), kMaxTeeth, 1);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const bool good = i == 0 ? angles[i] == 0 : angles[i] > angles[i - 1] && angles[i] < 2 * units::kPi;
    if (good) continue;
    return checker.refuse(ReasonKind::kNotAllowed, "cutter.tooth_angles", {angles[i], Unit::kRadian},
                          "0 first, then ascending, below", 2 * units::kPi);
  }
}

/// Checks numbers that are each within their range against each other.
void checkTogether(Checker& checker, const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const GrindProcess& p = job.process;
  const double growth = std::tan(c.cone_angle);
  const auto radius = [&](double x) { return c.end_diameter / 2 + x * growth; };
  const double apex = -c.end_diameter / 2 / growth;  // X at which the cone's radius is 0
  if (growth < 0) {
    checker.below("cutter.flute_length", c.flute_length, apex, "where the cone closes");
    if (!checker.good()) return;  // the other errors would follow from this one
    checker.below("process.overtravel_shank", p.overtravel_shank, apex - c.flute_length, "where the cone closes");
  } else if (growth > 0) {
    checker.below("process.overtravel_end", p.overtravel_end, -apex, "where the cone closes");
  }
  checker.below("process.depth", p.depth, std::min(radius(0), radius(c.flute_length)), "the cutter's smallest radius");
  checker.below("process.wheel_wear", p.wheel_wear, p.wheel_diameter / 2, "the wheel's radius");
  if (!(p.finish_infeed <= p.depth)) {
    checker.refuse(ReasonKind::kAbove, "process.finish_infeed", {p.finish_infeed, Unit::kMetre}, "the depth", p.depth);
  }
  const int allowed_passes = std::min(kMaxPasses, kMaxPassesOfAll / static_cast<int>(job.tooth_angles.size()));
  if (!(p.depth / p.infeed + p.spark_out + 2 <= allowed_passes)) {
    checker.refuse(ReasonKind::kNotAllowed, "process.infeed", {p.infeed, Unit::kMetre},
                   "enough for the depth in " + std::to_string(allowed_passes) + " passes per tooth, " +
                       std::to_string(kMaxPassesOfAll) + " of all teeth");
  }
  if (!checker.good()) return;
  const auto passes = static_cast<double>(job.tooth_angles.size() * passDepths(p).size());
  checker.below("process.wheel_wear_per_pass", p.wheel_wear_per_pass, (p.wheel_diameter / 2 - p.wheel_wear) / passes,
                "what is left of the wheel's radius, over the passes of all teeth");
}

}  // namespace

std::string toolText(const CutterGeometry& cutter, std::size_t teeth) {
  char text[200];
  std::snprintf(text, sizeof text, "D %g mm, cone %g deg, spiral %g deg, rake %g deg, %zu %s",
                cutter.end_diameter / units::kMillimetre, cutter.cone_angle / units::kDegree,
                cutter.spiral_angle / units::kDegree, cutter.rake_angle / units::kDegree, teeth,
                teeth == 1 ? "tooth" : "teeth");
  return text;
}

std::vector<core::Reason> validate(const GrindJob& job) {
  Checker checker;
  visitJobFields([&](const JobField& field, auto of) { checker.range(field, of(job)); });
  checkTeeth(checker, job.tooth_angles);
  visitJobChoices([&](const char* path, int max, auto of) { checker.whole(path, static_cast<int>(of(job)), max); });
  if (checker.good()) checkTogether(checker, job);
  return checker.take();
}

std::vector<double> passDepths(const GrindProcess& process) {
  // A depth that is a multiple of the infeed, except for rounding, needs no extra pass for the remainder.
  constexpr double rounding = 1e-9;
  const double rough = process.depth - process.finish_infeed;
  const int rough_passes = static_cast<int>(std::ceil(rough / process.infeed - rounding));
  std::vector<double> depths;
  for (int i = 1; i <= rough_passes; ++i) depths.push_back(i == rough_passes ? rough : i * process.infeed);
  if (process.finish_infeed > 0 || depths.empty()) depths.push_back(process.depth);
  depths.insert(depths.end(), static_cast<std::size_t>(process.spark_out), process.depth);
  return depths;
}

std::vector<ToothPass> passOrder(const GrindJob& job) {
  const int teeth = static_cast<int>(job.tooth_angles.size());
  const int passes = static_cast<int>(passDepths(job.process).size());
  const bool tooth_major = job.process.order == GrindOrder::kToothMajor;
  std::vector<ToothPass> order;
  order.reserve(static_cast<std::size_t>(teeth) * static_cast<std::size_t>(passes));
  for (int i = 0; i < teeth * passes; ++i) {
    order.push_back(tooth_major ? ToothPass{i / passes, i % passes} : ToothPass{i % teeth, i / teeth});
  }
  return order;
}

}  // namespace flute_grinder
