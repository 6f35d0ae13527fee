#include "flute_grinder/machine/offset_limits.h"

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"

#include <cmath>
#include <utility>

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

std::optional<Need> needOfChange(const OffsetLimits& limits, const WorkOffsets& from, const OffsetValues& to) {
  Need need{NeedKind::kLargeChange, "", {}, {NeedAnswer::kSetOffset}};
  for (const auto& [axis, value] : to) {
    const WorkOffset& was = from.axes[static_cast<std::size_t>(axis)];
    const double change = std::abs(value - was.value);
    if (!was.wasSet() || std::isnan(was.value) || change <= limits.change[axis]) continue;
    need.text += (need.text.empty() ? "" : "; ") + offsetOf(axis) + " would change by " + shown(axis, change) +
                 ", from " + shown(axis, was.value) + " to " + shown(axis, value) +
                 "; allowed without an answer: " + shown(axis, limits.change[axis]);
    need.figures.push_back(
        {axisName(axis), shown(axis, value), shown(axis, was.value), shown(axis, value - was.value)});
  }
  return need.figures.empty() ? std::nullopt : std::optional(std::move(need));
}

}  // namespace grinder
