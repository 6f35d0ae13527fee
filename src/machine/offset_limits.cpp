#include "flute_grinder/machine/offset_limits.h"

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"

#include <cmath>

namespace grinder {

namespace {

constexpr int kDigits = 9;  ///< digits enough for different offsets to look different

Quantity quantityOf(int axis, double value) { return {value, unitOf(axis, 0)}; }

std::string shown(int axis, double value) { return text(quantityOf(axis, value), kDigits); }

std::string offsetOf(int axis) { return "work offset of " + axisName(axis); }

}  // namespace

OffsetLimits offsetLimits(const AxisLimits& travel, const Axes& change) {
  OffsetLimits limits{travel.min_position, travel.max_position, change};
  limits.min[kA] -= 2 * units::kPi;
  limits.max[kA] += 2 * units::kPi;
  limits.min = limits.min.max(-kMaxOffset);
  limits.max = limits.max.min(kMaxOffset);
  return limits;
}

std::string travelRefusal(const OffsetLimits& limits, int axis, double value) {
  if (value >= limits.min[axis] && value <= limits.max[axis]) return "";
  return offsetOf(axis) + " = " + shown(axis, value) +
         "; allowed: " + text(quantityOf(axis, limits.min[axis]), quantityOf(axis, limits.max[axis]), kDigits) +
         ", the travel of the axis";
}

std::optional<Need> needOfChange(const OffsetLimits& limits, int axis, const WorkOffset& from, double to) {
  const double change = std::abs(to - from.value);
  if (!from.wasSet() || std::isnan(from.value) || change <= limits.change[axis]) return std::nullopt;
  return Need{NeedKind::kLargeChange,
              offsetOf(axis) + " would change by " + shown(axis, change) + ", from " + shown(axis, from.value) +
                  " to " + shown(axis, to) + "; allowed without an answer: " + shown(axis, limits.change[axis]),
              {{axisName(axis), shown(axis, to), shown(axis, from.value), shown(axis, to - from.value)}},
              {NeedAnswer::kSetOffset}};
}

}  // namespace grinder
