#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/curve/log_curve.h"

namespace grinder {

/// How the even step returns to the curve.
enum class EvenStepRule {
  kPublished,   ///< the paper's equations 14 and 15; the errors of the even steps accumulate
  kThirdOrder,  ///< circle and curve expanded in arc length to third order; fourth-order local error
  kExact,       ///< the circle's intersection with the curve; even points are on the curve except for rounding
};

/// Each rule with its name in job files.
inline constexpr EnumRow<EvenStepRule> kEvenStepRules[]{
    {EvenStepRule::kPublished, "published"},
    {EvenStepRule::kThirdOrder, "third_order"},
    {EvenStepRule::kExact, "exact"},
};
constexpr auto& rowsOf(EvenStepRule) noexcept { return kEvenStepRules; }

/// A point in the X-A plane.
struct CurvePoint {
  double x = 0;  ///< [m]
  double a = 0;  ///< [rad]
};

/// The two points of one odd-even pair.
struct OddEvenPair {
  CurvePoint odd;   ///< on the curve's tangent at the start of the pair
  CurvePoint even;  ///< back on the curve
};

/// Jiang & Chen's odd-even steps third-order interpolation of the logarithmic curve (paper, section 3), with two more
/// rules for the even step. Both steps of a pair have the same length in the metric sqrt(dX^2 + (rho dA)^2). The rotary
/// scale rho [m/rad] is the length equivalent to one radian; the paper measures X in mm and A in rad, so rho = 0.001.
/// The step length may change from pair to pair; a negative length moves backwards. Real-time safe.
class OddEvenInterpolator {
 public:
  /// @param rotary_scale rho [m/rad], positive.
  /// @param rule the rule for the even step.
  /// @param start_x X of the start, on the curve [m]; the whole path must stay where curve.u() > 0.
  OddEvenInterpolator(const LogCurve& curve, double rotary_scale, EvenStepRule rule, double start_x) noexcept;

  /// Advances by one pair.
  /// @param step_length length of each step in the metric [m].
  OddEvenPair next(double step_length) noexcept;

  /// Advances by the pair that moves `dx` [m] in X, to within rounding.
  OddEvenPair advance(double dx) noexcept;

  /// The last even point; before the first pair, the start.
  const CurvePoint& position() const noexcept { return p0_; }

  /// The step length for which the next pair advances by `dx` [m] in X; solved to within rounding.
  double stepLengthForAdvance(double dx) const noexcept;

  /// The maximum step length at `x` whose odd point deviates from the curve by at most `a_error` [rad] in A (leading
  /// order: |k b| step^2 / (2 h^2), which is the paper's tangent deviation step^2 |kappa| / 2 measured along A).
  /// Infinite where the curve is straight. [m]
  static double maxStepLength(const LogCurve& curve, double rotary_scale, double x, double a_error) noexcept;

 private:
  /// Increments of the two steps from p0_, A scaled to the metric [m].
  struct Increments {
    double x1, ra1;
    double x2, ra2;
  };

  /// The properties of the curve at the start of a pair.
  struct Tangent {
    double u, inverse_h, cos, sin;
  };

  OddEvenPair goTo(const CurvePoint& odd, const CurvePoint& even) noexcept;
  Tangent tangentAt(double x) const noexcept;
  Increments pair(double step_length) const noexcept;
  double exactStepLength(double dx) const noexcept;
  double intersectionX(double step_length, double guess) const noexcept;
  double contraction(double dx) const noexcept;

  LogCurve curve_;
  double rotary_scale_;
  double slope_scale_;  ///< K = rho k, slope of the curve at X = 0 in the metric
  EvenStepRule rule_;
  CurvePoint p0_;
  Tangent tangent_;  ///< tangent at p0_
};

}  // namespace grinder
