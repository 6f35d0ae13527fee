#pragma once

#include <array>

namespace flute_grinder {

/// Bounds of a motion along one coordinate, in units of that coordinate.
struct MotionLimits {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// Jerk-limited motion along one coordinate (double-S): from rest over a given distance, toward a target speed that may
/// change at any time, to rest exactly at the end of the distance. It follows a profile of at most seven phases of
/// constant jerk that always ends in a stop within the remaining distance, and so needs no look-ahead; the profile is
/// recomputed when the target changes. The same calls give the same bits. Real-time safe except for the constructor;
/// setTarget() takes microseconds, advance() nanoseconds.
class FeedLaw {
 public:
  /// At rest at the end of an empty motion.
  FeedLaw() noexcept = default;

  /// At rest at the start of `distance`.
  /// @param limits bounds of speed, acceleration and jerk.
  /// @param distance to travel, not negative.
  /// @param target speed, 0 to limits.velocity.
  /// @throw std::invalid_argument unless limits, distance and target are as stated and finite.
  FeedLaw(const MotionLimits& limits, double distance, double target);

  /// Restarts like the constructor, but without an exception. Real-time safe.
  /// @return false, without any change, unless limits, distance and target are valid for the constructor.
  bool begin(const MotionLimits& limits, double distance, double target) noexcept;

  /// Changes the target speed immediately; a target of 0 stops as soon as the limits allow, before the end of the
  /// distance. A target above the limit, or NaN, is ignored.
  /// @return whether the target was accepted.
  bool setTarget(double target) noexcept;

  /// For axes that stood still for a while: continues the same motion in slow motion, from where it is. Speed and
  /// acceleration are scaled in time, so that the remaining distance still suffices for a stop, even during braking;
  /// then accelerates again to the target.
  /// @param factor time scale, above 0 and below 1; other values are ignored.
  void slowDown(double factor) noexcept;

  /// Advances by `dt` [s], not negative.
  void advance(double dt) noexcept;

  double position() const noexcept { return position_; }  ///< from the start
  double speed() const noexcept { return speed_; }        ///< never negative, except by rounding
  double acceleration() const noexcept { return acceleration_; }
  double target() const noexcept { return target_; }
  const MotionLimits& limits() const noexcept { return limits_; }

  /// Time until the motion comes to rest if the target does not change [s].
  double timeLeft() const noexcept { return end_time_ - time_; }

  /// Whether it is at rest, at the end of the distance or because the target is 0.
  bool resting() const noexcept { return time_ >= end_time_; }

  /// Whether it rests at the distance's end; position() is then exactly the distance.
  bool finished() const noexcept { return resting() && position_ == distance_; }

  /// Whether it goes at the target speed without acceleration.
  bool cruising() const noexcept { return !resting() && acceleration_ == 0 && speed_ == target_; }

 private:
  struct State {
    double position, speed, acceleration;
  };
  struct Phase {
    double duration;
    double jerk;
  };
  /// A change of speed that ends without acceleration.
  using SpeedChange = std::array<Phase, 3>;

  SpeedChange changeSpeed(double speed, double acceleration, double to) const noexcept;
  double stoppingDistance(double through) const noexcept;
  /// The highest speed, up to the target, from which the way left suffices for a stop.
  double cruiseSpeed(double left) const noexcept;
  void plan() noexcept;
  void rest() noexcept;
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
  int final_braking_ = 0;  ///< its first segment; segment_count_ where the plan stops short of the end
  State end_{};
  double end_time_ = 0;
  double time_ = 0;  ///< since the plan was made
};

}  // namespace flute_grinder
