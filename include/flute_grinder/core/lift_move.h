#pragma once

#include "flute_grinder/core/axis_limits.h"
#include "flute_grinder/core/feed_law.h"
#include "flute_grinder/core/setpoint.h"

namespace flute_grinder {

/// Lifts the wheel radially without a job: moves only Y, upwards, from rest to rest within the axis limits. Its
/// setpoints are numbered from 0 and come in pairs, as in a job; hold() and slowDown() take effect at the next pair.
/// Real-time safe except for the constructor.
class LiftMove {
 public:
  /// At rest, with the lift finished.
  /// @throw std::invalid_argument unless the limits of Y are finite and positive.
  explicit LiftMove(const Machine& machine);

  /// Starts a new lift.
  /// @param from position of the axes, at rest [m], A [rad].
  /// @param to_y Y to lift to, finite [m]; if the wheel is already higher, nothing moves.
  void begin(const Axes& from, double to_y) noexcept;

  /// The next setpoint; the first is the position at rest.
  /// @return false once the axes are at rest again; `setpoint` is then unchanged.
  bool next(Setpoint& setpoint) noexcept;

  /// Stops as soon as the limits allow; the lift cannot be resumed.
  void hold() noexcept { holding_ = true; }

  /// See SetpointStream::slowDown().
  void slowDown(double factor) noexcept {
    if (factor > 0 && factor < slow_down_) slow_down_ = factor;
  }

  /// Whether the wheel has reached `to_y` and was not held.
  bool finished() const noexcept { return law_.finished(); }

 private:
  bool beginPair() noexcept;

  MotionLimits limits_;
  double period_;
  FeedLaw law_;
  Setpoint current_;
  double from_ = 0, to_ = 0;  ///< Y [m]
  bool started_ = true;
  bool mid_pair_ = false;
  bool holding_ = false;
  double slow_down_ = 1;  ///< for the next pair
};

}  // namespace flute_grinder
