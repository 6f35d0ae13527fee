#pragma once

#include "flute_grinder/core/axis_limits.h"
#include "flute_grinder/core/conical_cutter.h"
#include "flute_grinder/core/feed_law.h"
#include "flute_grinder/core/log_curve.h"

#include <string>
#include <vector>

namespace flute_grinder {

constexpr double kMaxFeedOverride = 1.2;  ///< the fastest that an operator may ask for, of the job's feed

namespace core {

/// What holds the feed below the one asked for, and where along the stroke.
struct FeedLimit {
  std::string cause;  ///< e.g. "axis_a velocity"; causeText() has it for the operator
  double from_x = 0;  ///< first in the direction of the stroke [m]
  double to_x = 0;    ///< [m]
};

}  // namespace core

/// Where along a stroke the feed must be cut so that no axis exceeds a limit, and what the feed law may do there.
///
/// A constant surface feed is a constant dX/dt = v. All that A asks for at that speed - velocity k v/u, acceleration
/// k b v^2/u^2, jerk 2 k b^2 v^3/u^3 - depends on v/u alone, so that A bounds the speed by c u with one constant c: at
/// the thin end of a cone the feed is cut in proportion to the radius and A turns evenly, elsewhere X goes evenly, and
/// in between a blend keeps the jerk bounded. The schedule is a parameter s along the stroke for which both is
/// "evenly": a feed law with constant limits in s obeys all limits of all axes, slows down ahead of a thin end by
/// itself, and may be stopped and slowed anywhere.
class FeedSchedule {
 public:
  /// What a stroke asks for.
  struct Stroke {
    double from = 0;          ///< X at the start [m]
    double to = 0;            ///< X at the end, on either side of the start [m]
    double surface_feed = 0;  ///< along the cutting edge [m/s]
    double tolerance = 0;     ///< largest deviation at the cutter's surface [m]
  };

  /// @param cutter the cutter, whose curve exists over the whole stroke.
  /// @param stroke the stroke.
  /// @param machine limits and control period.
  FeedSchedule(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine);

  /// Length of the stroke in s [m]: the travel in X, longer where the feed is cut.
  double length() const noexcept { return length_; }

  /// Bounds of the motion along s; the velocity is that of the job's feed times as much of kMaxFeedOverride as the axes
  /// allow, which is none where A holds the feed back [m/s].
  const MotionLimits& limits() const noexcept { return limits_; }

  /// Speed along s at the job's feed, which is the speed of X where A does not hold it back [m/s].
  double feedSpeed() const noexcept { return feed_speed_; }

  /// Way that it takes to reach the job's feed from rest. [m of s]
  double runUp() const noexcept;

  /// X at s; exactly the stroke's end at s = length(). Real-time safe. [m]
  double x(double s) const noexcept;

  /// dX/dt over ds/dt at s: 1 where the feed is not cut for A. Real-time safe.
  double rate(double s) const noexcept;

  /// What holds the feed below the one asked for; empty where nothing does.
  const std::vector<core::FeedLimit>& feedLimits() const noexcept { return feed_limits_; }

 private:
  void chooseSpeeds(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine);
  void chooseBlendAndLimits(const LogCurve& curve, const AxisLimits& limits);
  void placeOnCone(const LogCurve& curve);

  double parameterOf(double xi) const noexcept;  ///< inverse of distance()
  double distance(double q) const noexcept;      ///< toward the thick end, from where the blend starts [m]
  double slope(double q) const noexcept;         ///< its derivative

  // Speeds: v = min(speed_, speed_per_radius_ * u).
  double feed_speed_ = 0;        ///< dX/dt at the job's feed, where A does not limit it [m/s]
  double speed_ = 0;             ///< the same at the largest override [m/s]
  double speed_per_radius_ = 0;  ///< c [m/s]
  double tan_cone_ = 0;
  double sin_rake_ = 0;
  std::vector<core::FeedLimit> feed_limits_;

  // The parameter q of the blend: cut below 0, blend from 0 to blend_, full feed above.
  double beta_ = 0;        ///< relative growth of the speed per parameter where it is cut [1/m]
  double blend_ = 0;       ///< [m]
  double blend_rate_ = 1;  ///< rate at the blend's start

  MotionLimits limits_;
  double length_ = 0;
  double from_ = 0, to_ = 0;
  double q_from_ = 0, xi_from_ = 0;
  double q_direction_ = 1;  ///< +1 when s runs toward the thick end, -1 toward the thin one
  double direction_ = 1;    ///< sign of dX/ds
};

}  // namespace flute_grinder
