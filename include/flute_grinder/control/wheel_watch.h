#pragma once

#include "flute_grinder/control/loop_status.h"

#include <cmath>

namespace flute_grinder {

/// Tracks whether the wheel stands in the work. Real-time safe.
class WheelWatch {
 public:
  /// @param wheel as the program before this one left it.
  explicit WheelWatch(const Wheel& wheel) noexcept : wheel_(wheel) {}

  const Wheel& wheel() const noexcept { return wheel_; }

  /// A job starts.
  void startJob(const Wheel& wheel) noexcept { wheel_ = wheel; }
  /// The job has commanded the axes to this Y [m].
  void followJob(double y) noexcept { wheel_.in_work = y < wheel_.clear_y; }
  /// No job moves the axes, but the drive or a hand may have moved the wheel clear of the work.
  /// @param y the position in the machine's reference [m].
  void observePosition(double y) noexcept {
    if (std::isfinite(y) && y >= wheel_.clear_y) wheel_.in_work = false;
  }
  /// A lift without a job has come to its end.
  void finishLift() noexcept { wheel_.in_work = false; }

  /// Y up to which to lift the wheel [m].
  /// @param homed whether Y refers to the machine's reference; without it only the distance of the lift is known.
  /// @param y where the wheel stands [m].
  double liftTarget(bool homed, double y) const noexcept { return homed ? wheel_.clear_y : y + wheel_.lift; }

 private:
  Wheel wheel_;
};

}  // namespace flute_grinder
