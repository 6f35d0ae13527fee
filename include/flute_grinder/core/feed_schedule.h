#pragma once

#include "flute_grinder/core/axis_limits.h"
#include "flute_grinder/core/conical_cutter.h"
#include "flute_grinder/core/feed_law.h"
#include "flute_grinder/core/log_curve.h"

#include <string>

namespace flute_grinder {

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

  /// Bounds of the motion along s; the velocity is the speed of X where the feed is not cut [m/s].
  const MotionLimits& limits() const noexcept { return limits_; }

  /// X at s; exactly the stroke's end at s = length(). Real-time safe. [m]
  double x(double s) const noexcept;

  /// dX/dt over ds/dt at s: 1 where the feed is not cut for A. Real-time safe.
  double rate(double s) const noexcept;

  /// Which limit holds the feed below the one asked for, e.g. "axis_a velocity"; empty where the feed is never cut.
  const std::string& limitedBy() const noexcept { return limited_by_; }

 private:
  void bound(double& value, double candidate, const char* cause);
  void chooseSpeeds(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine);
  void chooseBlendAndLimits(const LogCurve& curve, const AxisLimits& limits);
  void placeOnCone(const LogCurve& curve);

  double parameterOf(double xi) const noexcept;  ///< inverse of distance()
  double distance(double q) const noexcept;      ///< toward the thick end, from where the blend starts [m]
  double slope(double q) const noexcept;         ///< its derivative

  // Speeds: v = min(speed_, speed_per_radius_ * u).
  double speed_ = 0;             ///< dX/dt where A does not limit it [m/s]
  double speed_per_radius_ = 0;  ///< c [m/s]
  double tan_cone_ = 0;
  double sin_rake_ = 0;
  std::string limited_by_;

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
