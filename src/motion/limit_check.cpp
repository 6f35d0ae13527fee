#include "flute_grinder/motion/limit_check.h"

#include <cmath>
#include <limits>

namespace grinder {

namespace {

/// Relative excess that can result from sampling a motion exactly at its limit.
constexpr double kRelativeRounding = 1e-9;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Whether every value is within its limits; false for NaN. Compares with the clamped value, which is computed for all
/// axes at once and takes half the time of comparisons.
bool between(const Axes& value, const Axes& low, const Axes& high) noexcept {
  return (value.max(low).min(high) - value).abs().sum() == 0;
}

/// Whether every |value| is within its limit; false for NaN.
bool within(const Axes& value, const Axes& limit) noexcept {
  const Axes size = value.abs();
  return (size.min(limit) - size).sum() == 0;
}

}  // namespace

LimitCheck::LimitCheck(const AxisLimits& limits, double period, double roundings) noexcept
    : limits_(limits),
      low_(limits.min_position),
      high_(limits.max_position),
      inverse_period_(1 / period),
      roundings_(roundings),
      ends_{Axes::Zero(), Axes::Zero(), Axes::Zero()} {}

std::optional<LimitViolation> LimitCheck::check(const Setpoint& setpoint, const Axes& offset) noexcept {
  const Axes& p = setpoint.position;
  if (seen_++ == 0) {
    last_ = p;
    for (Axes& end : ends_) end = p;
  }
  if (slow_down_ < 1 && setpoint.cycle % 2 == 1) slowPastDown();
  max_ = max_.max(p.abs());
  velocity_ = (p - last_) * inverse_period_;
  last_ = p;

  violation_count_ = 0;
  if (!between(p + offset, low_, high_)) checkPosition(setpoint, offset);
  if (!within(velocity_, limits_.max_velocity)) {
    checkSize(setpoint, LimitedQuantity::kVelocity, velocity_, limits_.max_velocity, inverse_period_);
  }
  if (setpoint.cycle % 2 == 0) checkPairEnd(setpoint);
  if (violation_count_ == 0) return std::nullopt;
  return violations_[0];
}

void LimitCheck::slowPastDown() noexcept {
  // Samples the parabola through the last three pair ends, one and two pairs back.
  const double f = slow_down_;
  const Axes change = ends_[0] - ends_[1];
  const Axes bend = change - (ends_[1] - ends_[2]);
  ends_[1] = ends_[0] - f * change - f * (1 - f) / 2 * bend;
  ends_[2] = ends_[0] - 2 * f * change - f * (1 - 2 * f) * bend;
  slow_down_ = 1;
}

void LimitCheck::checkPosition(const Setpoint& setpoint, const Axes& offset) noexcept {
  const Axes position = setpoint.position + offset;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    // A machine position at its limit is rounded when converted to work coordinates and back; a resumed stroke reaches
    // its end by a different sum.
    const double rounding = kEpsilon * std::abs(offset[axis]) + noise(axis);
    const bool low = position[axis] < low_[axis] - rounding;
    const double limit = low ? low_[axis] : high_[axis];
    if (!std::isfinite(position[axis])) {
      report(setpoint, axis, LimitedQuantity::kNotFinite, position[axis], limit);
    } else if (low || !(position[axis] <= limit + rounding)) {
      report(setpoint, axis, LimitedQuantity::kPosition, position[axis], limit);
    }
  }
}

double LimitCheck::noise(int axis) const noexcept {
  // A position is the sum of a few numbers up to max_[axis], each rounded to half an epsilon.
  return roundings_ * 2 * kEpsilon * max_[axis];
}

void LimitCheck::checkPairEnd(const Setpoint& setpoint) noexcept {
  const double inverse_pair = inverse_period_ / 2;
  const double inverse_pair2 = inverse_pair * inverse_pair;
  const Axes change = setpoint.position - ends_[0];
  const Axes last_change = ends_[0] - ends_[1];
  const Axes bend = change - last_change;
  acceleration_ = bend * inverse_pair2;
  jerk_ = (bend - (last_change - (ends_[1] - ends_[2]))) * (inverse_pair2 * inverse_pair);
  ends_[2] = ends_[1];
  ends_[1] = ends_[0];
  ends_[0] = setpoint.position;
  if (!within(acceleration_, limits_.max_acceleration)) {
    checkSize(setpoint, LimitedQuantity::kAcceleration, acceleration_, limits_.max_acceleration, 4 * inverse_pair2);
  }
  if (!within(jerk_, limits_.max_jerk)) {
    checkSize(setpoint, LimitedQuantity::kJerk, jerk_, limits_.max_jerk, 8 * inverse_pair2 * inverse_pair);
  }
}

void LimitCheck::checkSize(const Setpoint& setpoint, LimitedQuantity quantity, const Axes& value, const Axes& limit,
                           double rounding) noexcept {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    if (!(std::abs(value[axis]) <= limit[axis] * (1 + kRelativeRounding) + noise(axis) * rounding)) {
      report(setpoint, axis, quantity, value[axis], limit[axis]);
    }
  }
}

void LimitCheck::report(const Setpoint& setpoint, int axis, LimitedQuantity quantity, double value,
                        double limit) noexcept {
  violations_[violation_count_++] = {axis,          quantity,       value,
                                     limit,         setpoint.cycle, setpoint.position[kX],
                                     setpoint.move, setpoint.tooth, setpoint.pass};
}

Reason reasonOf(const LimitViolation& violation) {
  static constexpr std::array<ReasonKind, 5> kinds{ReasonKind::kPosition, ReasonKind::kVelocity,
                                                   ReasonKind::kAcceleration, ReasonKind::kJerk,
                                                   ReasonKind::kNotFinite};
  const auto quantity = static_cast<std::size_t>(violation.quantity);
  const bool position = violation.quantity == LimitedQuantity::kNotFinite;
  Reason reason;
  reason.kind = kinds[quantity];
  reason.axis = violation.axis;
  reason.unit = unitOf(violation.axis, position ? 0 : static_cast<int>(quantity));
  reason.value = violation.value;
  reason.limit = violation.limit;
  reason.has_place = true;
  reason.move = violation.move;
  reason.tooth = violation.tooth;
  reason.pass = violation.pass;
  reason.x = violation.x;
  reason.cycle = violation.cycle;
  return reason;
}

}  // namespace grinder
