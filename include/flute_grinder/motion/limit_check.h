#pragma once

#include "flute_grinder/job/reason.h"
#include "flute_grinder/motion/axis_limits.h"
#include "flute_grinder/motion/setpoint.h"

#include <array>
#include <optional>

namespace grinder {

/// The quantity that a limit applies to.
enum class LimitedQuantity { kPosition, kVelocity, kAcceleration, kJerk, kNotFinite };

/// A setpoint that exceeds a limit of an axis.
struct LimitViolation {
  int axis = 0;
  LimitedQuantity quantity = LimitedQuantity::kPosition;
  double value = 0;  ///< value of the quantity; positions in machine coordinates
  double limit = 0;
  std::uint64_t cycle = 0;
  double x = 0;  ///< position along the cutter, in work coordinates [m]
  MoveKind move = MoveKind::kLift;
  std::uint16_t tooth = 0;  ///< from 0
  std::uint16_t pass = 0;   ///< from 0
};

/// Converts a violation to a reason. Not real-time safe.
Reason reasonOf(const LimitViolation& violation);

/// Checks consecutive setpoints against the axis limits. Position and velocity are checked at every setpoint;
/// acceleration and jerk only at pair ends, from differences over two cycles, because within a pair they come from the
/// odd-even steps and not from the path. Excess due to rounding is ignored. Real-time safe.
class LimitCheck {
 public:
  /// @param limits the axes' limits.
  /// @param period control cycle [s].
  /// @param roundings tolerance for a position, in multiples of its rounding; 1 for planning, kUnplannedRoundings for
  ///        execution.
  LimitCheck(const AxisLimits& limits, double period, double roundings = 1) noexcept;

  /// The plan checks one representative of each shape of move, so rounding may put another up to 3 ulp over the limit.
  static constexpr double kUnplannedRoundings = 3;

  /// Discards the history: the axes are assumed to be at rest before the next setpoint.
  /// @param terms magnitudes of the numbers from which the next positions are computed, see GrindProgram::terms().
  void restart(const Axes& terms = Axes::Zero()) noexcept {
    low_ = limits_.min_position;
    high_ = limits_.max_position;
    seen_ = 0;
    slow_down_ = 1;
    max_ = terms;
  }

  /// Until the next restart, allows positions as far out as this one, for axes that are already there.
  void widen(const Axes& position) noexcept {
    low_ = low_.min(position);
    high_ = high_.max(position);
  }

  /// The nearest position within the limits.
  Axes clamped(const Axes& position) const noexcept { return position.max(low_).min(high_); }

  /// Adds magnitudes of numbers from which positions are computed from now on.
  void addTerms(const Axes& terms) noexcept { max_ = max_.max(terms); }

  /// Continues at a fraction of the speed, after the axes stood still for a while, see SCurveProfile::slowDown(). The
  /// stored history is scaled to the same speed, from the next pair on.
  /// @param factor speed factor, above 0 and below 1; other values are ignored.
  void slowDown(double factor) noexcept {
    if (factor > 0 && factor < slow_down_) slow_down_ = factor;
  }

  /// @param offset machine position - position of the setpoint [m], A [rad]. Only positions depend on it: velocity,
  ///        acceleration and jerk come from the setpoints, so plan and machine compute the same values, bit for bit.
  /// @return the first violation of the setpoint, if there is one; begin() to end() has all of them.
  std::optional<LimitViolation> check(const Setpoint& setpoint, const Axes& offset = Axes::Zero()) noexcept;

  /// All violations of the last setpoint checked.
  const LimitViolation* begin() const noexcept { return violations_.data(); }
  const LimitViolation* end() const noexcept { return violations_.data() + violation_count_; }

  /// The velocity at the last setpoint checked; acceleration and jerk at the last pair end.
  const Axes& velocity() const noexcept { return velocity_; }
  const Axes& acceleration() const noexcept { return acceleration_; }
  const Axes& jerk() const noexcept { return jerk_; }

 private:
  void slowPastDown() noexcept;
  void checkPosition(const Setpoint& setpoint, const Axes& offset) noexcept;
  double noise(int axis) const noexcept;  ///< rounding error of a position
  void checkPairEnd(const Setpoint& setpoint) noexcept;
  void checkSize(const Setpoint& setpoint, LimitedQuantity quantity, const Axes& value, const Axes& limit,
                 double rounding) noexcept;
  void report(const Setpoint& setpoint, int axis, LimitedQuantity quantity, double value, double limit) noexcept;

  AxisLimits limits_;
  Axes low_, high_;  ///< limits of positions
  double inverse_period_;
  double roundings_;
  std::uint64_t seen_ = 0;
  double slow_down_ = 1;  ///< factor for the next pair
  Axes last_ = Axes::Zero();
  Axes max_ = Axes::Zero();  ///< maximum magnitude of the positions so far, and of the numbers they are computed from
  Axes ends_[3];             ///< the last pair ends, newest first
  Axes velocity_ = Axes::Zero();
  Axes acceleration_ = Axes::Zero();
  Axes jerk_ = Axes::Zero();

  /// One violation for each axis and each of position, velocity, acceleration and jerk.
  std::array<LimitViolation, std::size_t{kAxisCount} * 4> violations_;
  std::size_t violation_count_ = 0;
};

}  // namespace grinder
