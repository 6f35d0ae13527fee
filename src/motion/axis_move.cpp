#include "flute_grinder/motion/axis_move.h"

#include <algorithm>
#include <cmath>

namespace grinder {

AxisMove::AxisMove(const Machine& machine) : period_(machine.period) {
  const AxisLimits& l = machine.limits;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    MotionLimits& limits = limits_[static_cast<std::size_t>(axis)];
    limits = {l.max_velocity[axis], l.max_acceleration[axis], l.max_jerk[axis]};
    law_ = SCurveProfile(limits, 0, limits.velocity);
  }
}

void AxisMove::begin(MoveKind kind, const Axes& from, int axis, double to, double speed) noexcept {
  current_ = Setpoint{};
  current_.position = from;
  current_.move = kind;
  axis_ = axis;
  from_ = from[axis];
  to_ = to;
  speed_ = speed;
  law_.begin(limits_[static_cast<std::size_t>(axis)], std::abs(to_ - from_), speed);
  started_ = mid_pair_ = false;
  slow_down_ = 1;
}

bool AxisMove::next(Setpoint& setpoint) noexcept {
  if (!started_) {
    started_ = true;
    setpoint = current_;
    return true;
  }
  if (!mid_pair_ && !beginPair()) return false;
  law_.advance(period_);
  const double before = current_.position[axis_];
  current_.position[axis_] = position();
  current_.velocity[axis_] = (current_.position[axis_] - before) / period_;
  current_.feed = axis_ == kA ? 0 : law_.speed();
  current_.move_fraction = law_.finished() ? 1 : law_.position() / std::abs(to_ - from_);
  ++current_.cycle;
  mid_pair_ = !mid_pair_;
  setpoint = current_;
  return true;
}

double AxisMove::position() const noexcept {
  if (law_.finished()) return to_;
  // The distance is rounded, so the sum may lie beyond the end.
  const double at = from_ + direction() * law_.position();
  return direction() > 0 ? std::min(at, to_) : std::max(at, to_);
}

bool AxisMove::beginPair() noexcept {
  law_.slowDown(slow_down_);
  slow_down_ = 1;
  law_.setTarget(speed_);
  return !law_.resting();
}

}  // namespace grinder
