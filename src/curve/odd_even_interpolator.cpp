#include "flute_grinder/curve/odd_even_interpolator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

/// Solves y(x) = goal for a nearly linear y: iterates with the slope at zero until only rounding remains.
/// @param contraction upper bound of the ratio of each correction to the previous one.
template <typename Function>
double solveNearlyLinear(double guess, double goal, double inverse_slope, double contraction, Function y) noexcept {
  constexpr int max_iterations = 30;  // far more than any path of a valid job takes
  double x = guess;
  for (int i = 0; i < max_iterations; ++i) {
    const double correction = (goal - y(x)) * inverse_slope;
    x += correction;
    if (!(std::abs(correction) * contraction > std::numeric_limits<double>::epsilon() / 2 * std::abs(x))) break;
  }
  return x;
}

}  // namespace

OddEvenInterpolator::OddEvenInterpolator(const LogCurve& curve, double rotary_scale, EvenStepRule rule,
                                         double start_x) noexcept
    : curve_(curve),
      rotary_scale_(rotary_scale),
      slope_scale_(rotary_scale * curve.k()),
      rule_(rule),
      p0_{start_x, curve.a(start_x)},
      tangent_(tangentAt(start_x)) {}

OddEvenPair OddEvenInterpolator::next(double step_length) noexcept {
  const Increments d = pair(step_length);
  const CurvePoint odd{p0_.x + d.x1, p0_.a + d.ra1 / rotary_scale_};
  const double x = odd.x + d.x2;
  return goTo(odd, {x, rule_ == EvenStepRule::kExact ? curve_.a(x) : odd.a + d.ra2 / rotary_scale_});
}

OddEvenPair OddEvenInterpolator::advance(double dx) noexcept {
  const double l = stepLengthForAdvance(dx);
  if (rule_ != EvenStepRule::kExact) return next(l);
  const double x = p0_.x + dx;
  return goTo({p0_.x + l * tangent_.cos, p0_.a + l * tangent_.sin / rotary_scale_}, {x, curve_.a(x)});
}

OddEvenPair OddEvenInterpolator::goTo(const CurvePoint& odd, const CurvePoint& even) noexcept {
  p0_ = even;
  tangent_ = tangentAt(even.x);
  return {odd, even};
}

OddEvenInterpolator::Tangent OddEvenInterpolator::tangentAt(double x) const noexcept {
  const double u = curve_.u(x);
  const double h = std::sqrt(u * u + slope_scale_ * slope_scale_);
  const double inverse = 1 / h;
  return {u, inverse, u * inverse, slope_scale_ * inverse};
}

OddEvenInterpolator::Increments OddEvenInterpolator::pair(double step_length) const noexcept {
  const Tangent& t = tangent_;
  const double l = step_length;
  const double x1 = l * t.cos;   // (8)
  const double ra1 = l * t.sin;  // (9)
  if (rule_ == EvenStepRule::kPublished) {
    // (14) and (15), with numerator and denominator divided by a^3 and a^2: also defined for C = 0 and S = 0.
    const double p = curve_.b() * l * t.inverse_h;
    const double sigma = t.sin * t.sin;
    const double inverse = 1 / (3 - 2 * p * sigma * (3 - 4 * p));
    return {x1, ra1, x1 * (3 - 2 * p * p * sigma * (3 - 8 * p)) * inverse, ra1 * (3 - 2 * p * (3 - 4 * p)) * inverse};
  }
  // Intersection of the circle about the odd point with the curve, at t along and n across the tangent, expanded in arc
  // length.
  const double inverse_h3 = t.inverse_h * t.inverse_h * t.inverse_h;
  const double curvature = -slope_scale_ * curve_.b() * t.u * inverse_h3;
  const double curvature_rate = -slope_scale_ * curve_.b() * curve_.b() * t.u *
                                (slope_scale_ * slope_scale_ - 2 * t.u * t.u) * inverse_h3 * inverse_h3;
  const double along = l - 2 * curvature * curvature * l * l * l;
  const double across = 2 * curvature * l * l + 4.0 / 3 * curvature_rate * l * l * l;
  const double x2 = along * t.cos - across * t.sin;
  if (rule_ == EvenStepRule::kExact) return {x1, ra1, intersectionX(l, x1 + x2) - x1, 0};
  return {x1, ra1, x2, along * t.sin + across * t.cos};
}

double OddEvenInterpolator::stepLengthForAdvance(double dx) const noexcept {
  if (rule_ == EvenStepRule::kExact) return exactStepLength(dx);
  const double inverse_slope = 0.5 / tangent_.cos;
  const double l = dx * inverse_slope;
  // The advance is 2 l cos(theta) (1 + sin^2(theta) b l / h) to second order.
  const double guess = l * (1 - tangent_.sin * tangent_.sin * curve_.b() * l * tangent_.inverse_h);
  return solveNearlyLinear(guess, dx, inverse_slope, contraction(dx), [&](double l) {
    const Increments d = pair(l);
    return d.x1 + d.x2;
  });
}

double OddEvenInterpolator::exactStepLength(double dx) const noexcept {
  // The start, odd and even points form an isosceles triangle with one leg along the tangent.
  const double ra = rotary_scale_ * curve_.delta(p0_.x, dx);
  const double projection = dx * tangent_.cos + ra * tangent_.sin;
  return projection == 0 ? 0 : (dx * dx + ra * ra) / (2 * projection);
}

double OddEvenInterpolator::intersectionX(double step_length, double guess) const noexcept {
  // Used instead of the circle's own equation, which loses half of the digits.
  return solveNearlyLinear(guess, step_length, 2 * tangent_.cos, contraction(guess),
                           [&](double x) { return exactStepLength(x); });
}

double OddEvenInterpolator::contraction(double dx) const noexcept {
  // The relative change of the slope over the pair, with a margin for higher-order terms.
  return std::min(1.0, 4 * std::abs(curve_.b() * dx) / tangent_.u);
}

double OddEvenInterpolator::maxStepLength(const LogCurve& curve, double rotary_scale, double x,
                                          double a_error) noexcept {
  const double k = rotary_scale * curve.k();
  const double u = curve.u(x);
  return std::sqrt(2 * a_error / std::abs(curve.k() * curve.b()) * (u * u + k * k));
}

}  // namespace grinder
