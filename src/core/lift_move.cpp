#include "flute_grinder/core/lift_move.h"

#include <algorithm>

namespace flute_grinder {

LiftMove::LiftMove(const Machine& machine)
    : limits_{machine.limits.max_velocity[kY], machine.limits.max_acceleration[kY], machine.limits.max_jerk[kY]},
      period_(machine.period),
      law_(limits_, 0, limits_.velocity) {}

void LiftMove::begin(const Axes& from, double to_y) noexcept {
  current_ = Setpoint{};
  current_.position = from;
  current_.move = MoveKind::kLift;
  from_ = from[kY];
  to_ = std::max(from_, to_y);
  law_ = FeedLaw(limits_, to_ - from_, limits_.velocity);
  started_ = mid_pair_ = holding_ = false;
  slow_down_ = 1;
}

bool LiftMove::next(Setpoint& setpoint) noexcept {
  if (!started_) {
    started_ = true;
    setpoint = current_;
    return true;
  }
  if (!mid_pair_ && !beginPair()) return false;
  law_.advance(period_);
  const double before = current_.position[kY];
  current_.position[kY] = law_.finished() ? to_ : from_ + law_.position();
  current_.velocity[kY] = (current_.position[kY] - before) / period_;
  current_.feed = law_.speed();
  current_.move_fraction = law_.finished() ? 1 : law_.position() / (to_ - from_);
  ++current_.cycle;
  mid_pair_ = !mid_pair_;
  setpoint = current_;
  return true;
}

bool LiftMove::beginPair() noexcept {
  law_.slowDown(slow_down_);
  slow_down_ = 1;
  if (holding_) law_.setTarget(0);
  return !law_.resting();
}

}  // namespace flute_grinder
