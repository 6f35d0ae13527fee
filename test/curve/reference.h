#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/curve/z_correction.h"

#include <cmath>

// The paper's formulas once more, in long double and by other ways than the code's, for tests to compare with.
namespace grinder::test_support {

using Real = long double;

/// A(X) = (k/b) ln(1 + b (X - shift)).
struct ReferenceCurve {
  Real b, k, x_shift = 0;

  ReferenceCurve(Real b_, Real k_) : b(b_), k(k_) {}
  explicit ReferenceCurve(const Cone& g, Real x_shift_ = 0)
      : b(2 * std::tan(Real(g.cone_angle)) / Real(g.end_diameter)),
        k(2 * std::tan(Real(g.spiral_angle)) / Real(g.end_diameter)),
        x_shift(x_shift_) {}

  Real u(Real x) const { return 1 + b * (x - x_shift); }
  Real slope(Real x) const { return k / u(x); }
  Real a(Real x) const { return b == 0 ? k * (x - x_shift) : k / b * std::log1p(b * (x - x_shift)); }
  /// A(x + dx) - A(x)
  Real delta(Real x, Real dx) const { return b == 0 ? k * dx : k / b * std::log1p(b * dx / u(x)); }
};

/// The B-spline of a degree whose knots are 0, 1, 2, ..., by the recursion of Cox and de Boor.
inline Real bSpline(int degree, Real t) {
  if (degree == 0) return t >= 0 && t < 1 ? 1 : 0;
  return (t * bSpline(degree - 1, t) + (degree + 1 - t) * bSpline(degree - 1, t - 1)) / degree;
}

/// A correction of Z within its range [m].
inline Real referenceCorrection(const ZCorrection& c, Real x) {
  Real sum = 0;
  if (c.pieces == 0) return sum;
  const Real t = (x - c.from) / c.piece;
  for (int i = 0; i < c.coefficientCount(); ++i) {
    sum += c.coefficients[static_cast<std::size_t>(i)] * bSpline(ZCorrection::kDegree, t - i + ZCorrection::kDegree);
  }
  return sum;
}

struct ReferencePair {
  Real x1, a1;  ///< the odd point, relative to the pair's start
  Real x2, a2;  ///< the even point, relative to the pair's start
};

/// Equations 8, 9, 14 and 15 as printed, with a = tan S / tan C; the paper's unit of A counts `scale` metres.
inline ReferencePair publishedPair(const ReferenceCurve& curve, Real scale, Real x, Real l) {
  const Real a = scale * curve.k / curve.b;
  const Real b = curve.b;
  const Real root = std::sqrt(curve.u(x) * curve.u(x) + a * b * a * b);
  const Real sin2 = (a * b / root) * (a * b / root);
  const Real x10 = curve.u(x) * l / root;
  const Real a10 = a * b * l / root;
  const Real bottom = 3 * a * a * a - 2 * a * a10 * sin2 * (3 * a - 4 * a10);
  const Real x21 = (3 * a * a * a - 2 * a10 * a10 * sin2 * (3 * a - 8 * a10)) / bottom * x10;
  const Real bottom2 = 3 * a * a - 2 * a10 * sin2 * (3 * a - 4 * a10);
  const Real a21 = (3 * a * a - 2 * a10 * (3 * a - 4 * a10)) / bottom2 * a10;
  return {x10, a10 / scale, x10 + x21, (a10 + a21) / scale};
}

/// The limits of the same for C to 0 (a to infinity, both fractions to 1) and S to 0 (a and A to 0).
inline ReferencePair straightPair(const ReferenceCurve& curve, Real scale, Real x, Real l) {
  const Real slope = scale * curve.k / curve.u(x);
  const Real x1 = l / std::sqrt(1 + slope * slope);
  const Real a1 = x1 * slope / scale;
  return {x1, a1, 2 * x1, 2 * a1};
}

/// Circle and curve expanded to third order, curvature and its rate from the derivatives of the curve's equation.
inline ReferencePair thirdOrderPair(const ReferenceCurve& curve, Real scale, Real x, Real l) {
  const Real u = curve.u(x);
  const Real y1 = scale * curve.k / u;
  const Real y2 = -scale * curve.k * curve.b / (u * u);
  const Real y3 = 2 * scale * curve.k * curve.b * curve.b / (u * u * u);
  const Real length = std::sqrt(1 + y1 * y1);  // of arc per X
  const Real curvature = y2 / (length * length * length);
  const Real curvature_by_x = y3 / std::pow(length, Real(3)) - 3 * y1 * y2 * y2 / std::pow(length, Real(5));
  const Real rate = curvature_by_x / length;
  const Real along = l - 2 * curvature * curvature * l * l * l;
  const Real across = 2 * curvature * l * l + Real(4) / 3 * rate * l * l * l;
  const Real angle = std::atan(y1);
  const Real c = std::cos(angle);
  const Real s = std::sin(angle);
  return {l * c, l * s / scale, l * c + along * c - across * s, (l * s + along * s + across * c) / scale};
}

/// The curve's point at the distance l from the odd point, by bisection.
inline ReferencePair exactPair(const ReferenceCurve& curve, Real scale, Real x, Real l) {
  const Real slope = scale * curve.slope(x);
  const Real x1 = l / std::sqrt(1 + slope * slope);
  const Real a1 = x1 * slope / scale;
  const auto beyond = [&](Real dx) {
    const Real across = scale * (curve.delta(x, dx) - a1);
    return (dx - x1) * (dx - x1) + across * across > l * l;
  };
  Real near = x1;
  Real far = x1 * Real(1.5);
  while (!beyond(far)) far += x1 / 2;
  for (int i = 0; i < 80; ++i) {
    const Real middle = (near + far) / 2;
    (beyond(middle) ? far : near) = middle;
  }
  return {x1, a1, near, curve.delta(x, near)};
}

inline ReferencePair referencePair(EvenStepRule rule, const ReferenceCurve& curve, Real scale, Real x, Real l) {
  switch (rule) {
    case EvenStepRule::kPublished:
      return curve.b == 0 || curve.k == 0 ? straightPair(curve, scale, x, l) : publishedPair(curve, scale, x, l);
    case EvenStepRule::kThirdOrder: return thirdOrderPair(curve, scale, x, l);
    case EvenStepRule::kExact: return exactPair(curve, scale, x, l);
  }
  return {};
}

}  // namespace grinder::test_support
