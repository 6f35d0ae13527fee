#pragma once

#include "flute_grinder/core/axis_limits.h"
#include "flute_grinder/core/reason.h"
#include "flute_grinder/core/setpoint.h"

#include <array>
#include <optional>

namespace flute_grinder {

/// What a limit bounds.
enum class LimitedQuantity { kPosition, kVelocity, kAcceleration, kJerk, kNotFinite };

/// A setpoint that an axis may not follow.
struct LimitViolation {
  int axis = 0;
  LimitedQuantity quantity = LimitedQuantity::kPosition;
  double value = 0;
  double limit = 0;
  std::uint64_t cycle = 0;
  double x = 0;  ///< where along the cutter [m]
  MoveKind move = MoveKind::kLift;
  std::uint16_t tooth = 0;  ///< from 0
  std::uint16_t pass = 0;   ///< from 0
};

/// A violation as a reason. Not real-time safe.
core::Reason reasonOf(const LimitViolation& violation);

/// Checks setpoints, one after another, against the axes' limits: position and velocity at every one, acceleration and
/// jerk at the pair ends, by differences over two cycles, since within a pair they are those of the odd-even steps and
/// not of the path. Excess due to rounding is ignored. Real-time safe.
class LimitCheck {
 public:
  /// @param limits the axes' limits.
  /// @param period control cycle [s].
  LimitCheck(const AxisLimits& limits, double period) noexcept;

  /// Forgets the past: the next setpoint is taken as preceded by rest.
  void restart() noexcept {
    seen_ = 0;
    slow_down_ = 1;
  }

  /// The axes stood for a while, and go on with a factor of their speed: FeedLaw::slowDown(). What is known of the past
  /// is taken to have gone that slowly too, from the next pair on.
  /// @param factor above 0, below 1; others are not taken.
  void slowDown(double factor) noexcept {
    if (factor > 0 && factor < slow_down_) slow_down_ = factor;
  }

  /// @return the first violation, if the setpoint is one; violations() has all.
  std::optional<LimitViolation> check(const Setpoint& setpoint) noexcept;

  /// All violations of the last setpoint checked.
  const LimitViolation* begin() const noexcept { return violations_.data(); }
  const LimitViolation* end() const noexcept { return violations_.data() + violation_count_; }

  /// Of the last setpoint checked, or pair end: what it asked of the axes.
  const Axes& velocity() const noexcept { return velocity_; }
  const Axes& acceleration() const noexcept { return acceleration_; }
  const Axes& jerk() const noexcept { return jerk_; }

 private:
  void slowPastDown() noexcept;
  void checkPosition(const Setpoint& setpoint) noexcept;
  void checkPairEnd(const Setpoint& setpoint) noexcept;
  void checkSize(const Setpoint& setpoint, LimitedQuantity quantity, const Axes& value, const Axes& limit,
                 double rounding) noexcept;
  void report(const Setpoint& setpoint, int axis, LimitedQuantity quantity, double value, double limit) noexcept;

  AxisLimits limits_;
  double inverse_period_;
  std::uint64_t seen_ = 0;
  double slow_down_ = 1;  ///< of the next pair
  Axes last_ = Axes::Zero();
  Axes largest_ = Axes::Zero();  ///< position in size
  Axes ends_[3];                 ///< the last pair ends, newest first
  Axes velocity_ = Axes::Zero();
  Axes acceleration_ = Axes::Zero();
  Axes jerk_ = Axes::Zero();

  /// One for each axis and each of position, velocity, acceleration and jerk.
  std::array<LimitViolation, std::size_t{kAxisCount} * 4> violations_;
  std::size_t violation_count_ = 0;
};

}  // namespace flute_grinder
