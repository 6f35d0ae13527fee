#pragma once

#include "flute_grinder/curve/s_curve_profile.h"
#include "flute_grinder/motion/axis_limits.h"
#include "flute_grinder/motion/setpoint.h"

#include <array>

namespace grinder {

/// Moves a single axis outside the program, from rest to rest within its limits: a lift or a jog. Its setpoints are
/// numbered from 0 and come in pairs, as in a job; setSpeed() and slowDown() take effect at the next pair. Real-time
/// safe except for the constructor.
class AxisMove {
 public:
  /// The new object is at rest, with the move finished.
  /// @throw std::invalid_argument unless the limits of every axis are finite and positive.
  explicit AxisMove(const Machine& machine);

  /// Starts a new move.
  /// @param kind kind of its setpoints.
  /// @param from position of the axes, at rest [m], A [rad].
  /// @param axis the axis that moves.
  /// @param to its position at the end, finite [m], A [rad]; if equal to `from`, nothing moves.
  /// @param speed target speed, 0 to the limit of the axis [m/s], A [rad/s].
  void begin(MoveKind kind, const Axes& from, int axis, double to, double speed) noexcept;

  /// The next setpoint; the first is the position at rest.
  /// @return false while the axis is at rest: at its end, or at speed 0; `setpoint` is then unchanged.
  bool next(Setpoint& setpoint) noexcept;

  /// Changes the target speed; 0 stops as soon as the limits allow. A speed outside 0 to the limit is ignored.
  void setSpeed(double speed) noexcept {
    if (speed >= 0 && speed <= law_.limits().velocity) speed_ = speed;
  }

  /// Whether the axis is stopping or was stopped.
  bool stopping() const noexcept { return speed_ == 0; }

  /// See SetpointStream::slowDown().
  void slowDown(double factor) noexcept {
    if (factor > 0 && factor < slow_down_) slow_down_ = factor;
  }

  /// Whether the axis has reached its end.
  bool finished() const noexcept { return law_.finished(); }

  int axis() const noexcept { return axis_; }
  double to() const noexcept { return to_; }  ///< position of the axis at the end [m], A [rad]
  /// Sign of the motion; +1 if there is none.
  int direction() const noexcept { return to_ < from_ ? -1 : 1; }

 private:
  bool beginPair() noexcept;
  double position() const noexcept;  ///< position of the axis, never beyond its end [m], A [rad]

  std::array<MotionLimits, kAxisCount> limits_;
  double period_;
  SCurveProfile law_;
  Setpoint current_;
  int axis_ = kX;
  double from_ = 0, to_ = 0;  ///< ends of the move [m], A [rad]
  double speed_ = 0;
  bool started_ = true;
  bool mid_pair_ = false;
  double slow_down_ = 1;  ///< factor for the next pair
};

}  // namespace grinder
