#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/curve/s_curve_profile.h"

namespace grinder {

/// How fast a Stroke runs, and how it is interpolated.
struct StrokeFeed {
  double feed = 0;          ///< feed along the cutting edge [m/s]
  double acceleration = 0;  ///< maximum acceleration of X [m/s^2]
  double jerk = 0;          ///< maximum jerk of X [m/s^3]
  double period = 0.001;    ///< duration of a control cycle, which is a step [s]
  EvenStepRule rule = EvenStepRule::kThirdOrder;
  double rotary_scale = units::kMillimetrePerRadian;  ///< see OddEvenInterpolator [m/rad]
};

/// A position of a Stroke.
struct StrokePoint {
  double x = 0, y = 0, z = 0;  ///< [m]
  double a = 0;                ///< [rad]
  double error = 0;            ///< A of the curve at `x`, less `a` [rad]
};

/// One stroke along a cone's helix, from rest to rest: a position for every control cycle, without job or machine. The
/// feed along the edge is constant, so X moves at constant speed between its jerk-limited ramps. Only X has limits:
/// where a machine's other axes matter, planJob() of the module `motion` plans the stroke. The same calls give the same
/// bits.
class Stroke {
 public:
  /// @param from,to X of the ends, in the direction of travel [m].
  /// @throw std::invalid_argument naming the bad value, unless the cone is as for ConicalCutter and open at both ends,
  ///        all figures of the feed are finite and positive, and no step is longer than an eighth of the distance to
  ///        the cone's apex.
  Stroke(const Cone& cone, double from, double to, const StrokeFeed& feed);

  /// The next position; the first is the start, at rest. Real-time safe.
  /// @return false while the stroke rests, at its end or at a feed override of 0; `point` is then unchanged.
  bool next(StrokePoint& point) noexcept;

  /// Changes the feed from the next pair of positions on, as fast as the limits allow; 0 holds. Real-time safe.
  /// @param fraction of the feed, 0 to 1; other values are ignored.
  void setFeedOverride(double fraction) noexcept;

  /// Whether the stroke rests at its end.
  bool finished() const noexcept { return law_.finished() && !even_is_next_; }

 private:
  StrokePoint at(const CurvePoint& point) const noexcept;

  ConicalCutter cutter_;
  LogCurve curve_;
  OddEvenInterpolator interpolator_;
  SCurveProfile law_;
  double from_, direction_, period_;
  bool even_is_next_ = true;  ///< the interpolator's position has not been given yet; at first, the start
};

}  // namespace grinder
