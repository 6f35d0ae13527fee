#pragma once

#include <array>
#include <cstdint>

namespace grinder {

/// Limits of a motion along one coordinate, in units of that coordinate.
struct MotionLimits {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// Jerk-limited motion along one coordinate (double-S): starts at rest, follows a target speed that may change at any
/// time, and comes to rest exactly at the given distance. The profile has at most seven phases of constant jerk and
/// always ends in a stop within the remaining distance, so it needs no look-ahead; it is recomputed when the target
/// changes. The same calls give bit-identical results. Real-time safe except for the constructor; setTarget() takes
/// microseconds, advance() nanoseconds.
class SCurveProfile {
 public:
  /// At rest at the end of a motion of length 0.
  SCurveProfile() noexcept = default;

  /// At rest at the start of `distance`.
  /// @param limits limits of speed, acceleration and jerk.
  /// @param distance distance to travel, not negative.
  /// @param target target speed, 0 to limits.velocity.
  /// @throw std::invalid_argument unless limits, distance and target are as stated and finite.
  SCurveProfile(const MotionLimits& limits, double distance, double target);

  /// Restarts like the constructor, but does not throw. Real-time safe.
  /// @return false, and nothing changes, unless limits, distance and target are valid for the constructor.
  bool begin(const MotionLimits& limits, double distance, double target) noexcept;

  /// Changes the target speed immediately; a target of 0 stops as soon as the limits allow, before the end of the
  /// distance. During the final braking a new target takes effect only after slowDown(). A target outside 0 to
  /// limits().velocity is ignored.
  /// @return whether the target is in that range.
  bool setTarget(double target) noexcept;

  /// Continues the same motion at reduced speed from the current position, after the axes stood still for a while.
  /// Speed and acceleration are scaled in time, so the remaining distance still suffices for a stop, even during
  /// braking; the motion then accelerates to the target again.
  /// @param factor time scale, above 0 and below 1; other values are ignored.
  void slowDown(double factor) noexcept;

  /// Advances by `dt` [s], not negative.
  void advance(double dt) noexcept;

  /// If the motion has run at the target speed for `margin` [s], advances in pairs of `dt` [s] up to twice `margin`
  /// before it leaves that speed; otherwise does nothing.
  /// @param at_most maximum number of advances by `dt`.
  /// @return the number of advances by `dt`.
  std::uint64_t skipCruise(double dt, double margin, std::uint64_t at_most) noexcept;

  double position() const noexcept { return position_; }  ///< distance from the start of the motion
  double speed() const noexcept { return speed_; }        ///< never negative, except by rounding
  double acceleration() const noexcept { return acceleration_; }
  double target() const noexcept { return target_; }
  const MotionLimits& limits() const noexcept { return limits_; }

  /// Time until the motion comes to rest if the target does not change [s].
  double timeLeft() const noexcept { return end_time_ - time_; }

  /// Whether the motion is at rest, at the end of the distance or because the target is 0.
  bool resting() const noexcept { return time_ >= end_time_; }

  /// Whether the motion is at rest at the end of the distance; position() then equals the distance exactly.
  bool finished() const noexcept { return resting() && position_ == distance_; }

  /// Whether the motion runs at the target speed without acceleration.
  bool cruising() const noexcept { return !resting() && acceleration_ == 0 && speed_ == target_; }

 private:
  struct State {
    double position, speed, acceleration;
  };
  struct Phase {
    double duration;
    double jerk;
  };
  /// A change of speed that ends with zero acceleration.
  using SpeedChange = std::array<Phase, 3>;

  SpeedChange changeSpeed(double speed, double acceleration, double to) const noexcept;
  double stoppingDistance(double through) const noexcept;
  /// The highest speed, up to the target, from which the remaining distance suffices for a stop.
  double cruiseSpeed(double left) const noexcept;
  void plan() noexcept;
  void rest() noexcept;
  void follow(int segment) noexcept;
  void append(const Phase& phase, State& state) noexcept;
  void append(const SpeedChange& change, double end_speed, State& state) noexcept;

  static State after(const State& state, double jerk, double dt) noexcept;

  MotionLimits limits_;
  double distance_ = 0;
  double target_ = 0;

  double position_ = 0;
  double speed_ = 0;
  double acceleration_ = 0;

  struct Segment {
    double start_time;
    State start;
    double jerk;
  };
  std::array<Segment, 7> segments_{};
  int segment_count_ = 0;
  int segment_ = 0;
  int final_braking_ = 0;  ///< first segment of the final braking; segment_count_ if the plan stops short of the end
  State end_{};
  double end_time_ = 0;
  double time_ = 0;  ///< time since the plan was made
};

}  // namespace grinder
