#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/curve/s_curve_profile.h"
#include "flute_grinder/curve/z_correction.h"
#include "flute_grinder/motion/axis_limits.h"

#include <string>
#include <vector>

namespace grinder {

constexpr double kMaxFeedOverride = 1.2;  ///< maximum feed override, as a fraction of the job's feed

/// What limits the feed to less than the requested feed, and where along the stroke.
struct FeedLimit {
  std::string cause;  ///< cause in words, e.g. "axis A velocity"
  double from_x = 0;  ///< X of the end that the stroke reaches first [m]
  double to_x = 0;    ///< X of the other end [m]
};

/// Where along a stroke the feed must be reduced so that no axis exceeds a limit, and the limits of the feed law there.
///
/// A constant surface feed is a constant dX/dt = v. At that speed the demands on A - velocity k v/u, acceleration k b
/// v^2/u^2, jerk 2 k b^2 v^3/u^3 - depend only on v/u, so A limits the speed to c u with a single constant c. At the
/// thin end of a cone the feed is therefore reduced in proportion to the radius, and A turns at constant speed;
/// elsewhere X moves at constant speed; a blend between the two keeps the jerk bounded. The schedule is a parameter s
/// along the stroke that advances at constant speed in both cases. A feed law with constant limits in s obeys all
/// limits of all axes, slows down ahead of a thin end without further measures, and can be stopped or slowed anywhere.
///
///     dX/dt                        ________________  v: X limits, ds = dX
///       |                     _.-'
///       |                  .-'    blend: the jerk is bounded
///       |              _.-'
///       |          _.-'  c u: A limits, and turns at constant speed; u = radius / end radius
///       |      _.-'
///       +-----+-------------------------------------> X
///         small end                          shank
///
/// Y moves in proportion to X, and so does Z by the published law. With a correction, the curvature of Z over X uses a
/// part of Z's limits: (d2Z/dX2) v^2 of the acceleration, (d3Z/dX3) v^3 + 3 (d2Z/dX2) v dv/dt of the jerk. The feed
/// remains the feed of the helix A(X) on the cone: a correction moves the ground edge round the cone by about as much
/// as Z, some micrometres per millimetre of X, which changes the edge's length by a thousandth.
class FeedSchedule {
 public:
  /// The requested stroke.
  struct Stroke {
    double from = 0;             ///< X at the start [m]
    double to = 0;               ///< X at the end, before or after the start [m]
    double surface_feed = 0;     ///< feed along the cutting edge [m/s]
    double tolerance = 0;        ///< maximum allowed deviation at the cutter's surface [m]
    double taper = 0;            ///< maximum magnitude of the taper that passes add to the cone's dY/dX
    ZCorrection z_correction{};  ///< correction added to Z
    double x_shift = 0;          ///< shift of A's curve along X, see LogCurve [m]
  };

  /// @param cutter its curve must exist over the whole stroke.
  /// @param stroke the stroke.
  /// @param machine limits and control period.
  FeedSchedule(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine);

  /// Length of the stroke in s [m]: equal to the travel in X, or longer if the feed is reduced.
  double length() const noexcept { return length_; }

  /// Limits of the motion along s. The velocity limit is the speed at the job's feed, times kMaxFeedOverride or as much
  /// of it as axes and tolerance allow; no override above 1 is possible if the feed is reduced [m/s].
  const MotionLimits& limits() const noexcept { return limits_; }

  /// Speed along s at the job's feed; equals the speed of X where A does not limit it [m/s].
  double feedSpeed() const noexcept { return feed_speed_; }

  /// Distance along s needed to reach the job's feed from rest [m].
  double runUp() const noexcept;

  /// X at s; exactly the end of the stroke at s = length(). Real-time safe. [m]
  double x(double s) const noexcept;

  /// (dX/dt) / (ds/dt) at s: 1 where A does not reduce the feed. Real-time safe.
  double rate(double s) const noexcept;

  /// What limits the feed to less than the requested feed; empty if nothing does.
  const std::vector<FeedLimit>& feedLimits() const noexcept { return feed_limits_; }

 private:
  /// A limit of X, and the axis that causes it.
  struct ForX {
    double limit;
    int axis;
  };
  ForX forX(const Axes& limit) const noexcept;
  ForX accelerationForX(const AxisLimits& limits, double speed) const noexcept;
  ForX jerkForX(const AxisLimits& limits, double speed) const noexcept;
  void chooseSpeeds(const ConicalCutter& cutter, const Stroke& stroke, const Machine& machine);
  void chooseBlendAndLimits(const LogCurve& curve, const AxisLimits& limits);
  void placeOnCone(const LogCurve& curve);

  double parameterOf(double xi) const noexcept;  ///< inverse of distance()
  double distance(double q) const noexcept;      ///< distance from the start of the blend toward the thick end [m]
  double slope(double q) const noexcept;         ///< derivative of distance()

  // Speeds: v = min(speed_, speed_per_radius_ * u).
  double feed_speed_ = 0;        ///< dX/dt at the job's feed, where A does not limit it [m/s]
  double speed_ = 0;             ///< dX/dt at the maximum override, where A does not limit it [m/s]
  double speed_per_radius_ = 0;  ///< c [m/s]
  double y_per_x_ = 0;           ///< maximum |dY/dX|
  double z_per_x_ = 0;           ///< maximum |dZ/dX|
  double z_bend_ = 0;            ///< maximum |d^2 Z/dX^2| [1/m]
  double z_twist_ = 0;           ///< maximum |d^3 Z/dX^3| [1/m^2]
  std::vector<FeedLimit> feed_limits_;

  // The blend's parameter q: reduced feed below 0, blend from 0 to blend_, full feed above.
  double beta_ = 0;        ///< relative growth of the speed per unit of q where the feed is reduced [1/m]
  double blend_ = 0;       ///< length of the blend [m]
  double blend_rate_ = 1;  ///< rate at the start of the blend

  MotionLimits limits_;
  double length_ = 0;
  double from_ = 0, to_ = 0;
  double q_from_ = 0, xi_from_ = 0;
  double q_direction_ = 1;  ///< +1 if s runs toward the thick end, -1 toward the thin end
  double direction_ = 1;    ///< sign of dX/ds
};

}  // namespace grinder
