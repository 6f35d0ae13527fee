#pragma once

#include "flute_grinder/core/axis_limits.h"
#include "flute_grinder/core/feed_law.h"
#include "flute_grinder/core/setpoint.h"

namespace flute_grinder {

/// Lifts the wheel radially, without a job: pure motion of Y, upwards, from rest to rest within the axis' limits. Its
/// setpoints are numbered from 0 and come in pairs, as in a job; hold() and slowDown() take effect with the next pair.
/// Real-time safe except for the constructor.
class LiftMove {
 public:
  /// At rest, lifted.
  /// @throw std::invalid_argument unless the limits of Y are finite and positive.
  explicit LiftMove(const Machine& machine);

  /// Starts a new lift.
  /// @param from where the axes rest [m], A [rad].
  /// @param to_y Y to lift to, finite [m]; if the wheel is already higher, nothing moves.
  void begin(const Axes& from, double to_y) noexcept;

  /// The next setpoint; the first is where the axes rest.
  /// @return false once they rest again; `setpoint` is then left as it was.
  bool next(Setpoint& setpoint) noexcept;

  /// Stops as soon as the limits allow; cannot be resumed.
  void hold() noexcept { holding_ = true; }

  /// As in SetpointStream.
  void slowDown(double factor) noexcept {
    if (factor > 0 && factor < slow_down_) slow_down_ = factor;
  }

  /// Whether the wheel has reached `to_y`, without a hold.
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
  double slow_down_ = 1;  ///< of the next pair
};

}  // namespace flute_grinder
