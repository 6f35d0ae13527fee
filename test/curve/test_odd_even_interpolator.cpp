#include "flute_grinder/curve/odd_even_interpolator.h"

#include "curve/generators.h"
#include "reference.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {
namespace test_odd_even_interpolator {

using namespace test_support;

constexpr double kPaperScale = 1e-3;  ///< X in mm, A in rad
constexpr double kMm = units::kMillimetre;
constexpr double kEps = std::numeric_limits<double>::epsilon();

LogCurve curveOf(const Cone& g) { return LogCurve(ConicalCutter(g)); }

/// A cutter on which the rules differ: D1 2 mm, S 45 deg, C 15 deg, 20 mm.
Cone steepCutter() { return {2e-3, 15 * units::kDegree, 45 * units::kDegree, 0, 20e-3}; }

/// Theory minus commanded, theory in long double. [rad]
double errorOf(const ReferenceCurve& curve, const CurvePoint& p) { return static_cast<double>(curve.a(p.x) - p.a); }

/// Of the even points of a path of fixed steps from X = 0 on. [rad]
double maxEvenError(const Cone& g, EvenStepRule rule, double step, double end) {
  const ReferenceCurve curve(g);
  OddEvenInterpolator interpolator(curveOf(g), kPaperScale, rule, 0);
  double max = 0;
  while (interpolator.position().x < end) max = std::max(max, std::abs(errorOf(curve, interpolator.next(step).even)));
  return max;
}

TEST(OddEvenInterpolator, TheEvenErrorFallsWithTheSquareOrTheCubeOfTheStep) {
  for (const Cone& cutter : {paperCone(), steepCutter()}) {
    SCOPED_TRACE(::testing::PrintToString(cutter.end_diameter));
    const auto even = [&](EvenStepRule rule, double step) { return maxEvenError(cutter, rule, step * kMm, 20 * kMm); };
    EXPECT_NEAR(even(EvenStepRule::kPublished, 0.01) / even(EvenStepRule::kPublished, 0.005), 4, 0.2);
    EXPECT_NEAR(even(EvenStepRule::kThirdOrder, 0.04) / even(EvenStepRule::kThirdOrder, 0.02), 8, 0.4);
    EXPECT_LE(even(EvenStepRule::kExact, 0.2), 2e-15);
  }
}

/// How far to go in X for the radius to grow or shrink by `growth` of itself. [m]
double advanceOfGrowth(const LogCurve& curve, double x, double growth) {
  return growth * curve.u(x) / std::max(std::abs(curve.b()), 1e-9);
}

/// A curve of a random cutter, a place on it and a step that turns the path by no more than a few degrees.
struct Place {
  Cone cutter;
  LogCurve curve;
  ReferenceCurve reference;
  double scale;
  double x;

  static Place draw() {
    const Cone g = *test_support::cone();
    const double x = *uniform(-test_support::openLength(g, -1, 2e-3), g.flute_length);
    return {g, curveOf(g), ReferenceCurve(g), *test_support::logUniform(0.1e-3, 10e-3), x};
  }

  /// A step over which the radius grows or shrinks by `growth` at most, up to 0.5 mm, of either sign.
  double drawStep(double growth) const {
    const double longest = std::min(0.5 * kMm, advanceOfGrowth(curve, x, growth));
    const double u = curve.u(x);
    const double slope = scale * curve.k() / u;
    return *rc::gen::element(-1.0, 1.0) * *test_support::logUniform(1e-4 * longest, longest) *
           std::sqrt(1 + slope * slope);
  }

  Real errorOfOdd(const CurvePoint& odd) const {
    return reference.delta(x, Real(odd.x) - x) - (Real(odd.a) - curve.a(x));
  }
};

EvenStepRule drawRule() {
  return *rc::gen::element(EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact);
}

RC_GTEST_PROP(OddEvenInterpolatorProperty, APairBeginsOnTheCurveAndIsThatOfTheRulesFormulas, ()) {
  const Place place = Place::draw();
  const EvenStepRule rule = drawRule();
  const double step = place.drawStep(0.1);
  OddEvenInterpolator interpolator(place.curve, place.scale, rule, place.x);
  const CurvePoint start = interpolator.position();
  RC_ASSERT(start.x == place.x);
  RC_ASSERT(std::abs(errorOf(place.reference, start)) <= 8 * kEps * (1 + std::abs(start.a)));
  RC_ASSERT(interpolator.stepLengthForAdvance(0) == 0);
  const OddEvenPair pair = interpolator.next(step);
  RC_ASSERT(interpolator.position().x == pair.even.x);
  RC_ASSERT(interpolator.position().a == pair.even.a);
  const ReferencePair expected = test_support::referencePair(rule, place.reference, place.scale, place.x, step);
  const Real x_tolerance = 1e-13 * std::abs(step) + 4 * kEps * std::abs(place.x);
  RC_ASSERT(std::abs(Real(pair.odd.x) - place.x - expected.x1) <= x_tolerance);
  RC_ASSERT(std::abs(Real(pair.even.x) - place.x - expected.x2) <= x_tolerance);
  RC_ASSERT(std::abs(Real(pair.odd.a) - start.a - expected.a1) <= Real(1e-11));
  RC_ASSERT(std::abs(Real(pair.even.a) - start.a - expected.a2) <= Real(1e-11));
}

RC_GTEST_PROP(OddEvenInterpolatorProperty, StepLengthForAdvanceAdvancesByThat, ()) {
  const Place place = Place::draw();
  const EvenStepRule rule = drawRule();
  const double longest = std::min(1 * kMm, 0.1 * place.curve.u(place.x) / std::max(std::abs(place.curve.b()), 1e-9));
  const double dx = *rc::gen::element(-1.0, 1.0) * *test_support::logUniform(1e-6 * longest, longest);
  OddEvenInterpolator interpolator(place.curve, place.scale, rule, place.x);
  const OddEvenPair pair = interpolator.next(interpolator.stepLengthForAdvance(dx));
  const Real advance = Real(pair.even.x) - place.x;
  RC_ASSERT(std::abs(advance - dx) <= kEps * (16 * std::abs(dx) + 4 * std::abs(place.x)));
}

RC_GTEST_PROP(OddEvenInterpolatorProperty, LargestStepLengthUsesUpTheErrorAllowed, ()) {
  const Place place = Place::draw();
  RC_PRE(std::abs(place.curve.k() * place.curve.b()) > 1e-3);
  const double allowed = *test_support::logUniform(1e-10, 1e-4);
  const double step = OddEvenInterpolator::maxStepLength(place.curve, place.scale, place.x, allowed);
  const Real u = place.reference.u(place.x);
  const Real slope = place.scale * place.reference.slope(place.x);
  const Real growth = std::abs(place.reference.b) * step / std::sqrt(1 + slope * slope) / u;
  RC_PRE(growth < Real(0.2));
  // The next order of ln(1 + z), z = growth, is 2/3 z of the leading one.
  const Real margin = growth + Real(1e-6);
  OddEvenInterpolator interpolator(place.curve, place.scale, EvenStepRule::kExact, place.x);
  const Real error = std::abs(place.errorOfOdd(interpolator.next(step).odd));
  const Real rounding = 4 * kEps * (1 + std::abs(place.curve.a(place.x)));
  RC_ASSERT(error <= allowed * (1 + margin) + rounding);
  RC_ASSERT(error >= allowed * (1 - margin) - rounding);
}

TEST(OddEvenInterpolator, LargestStepLengthIsInfiniteWhereTheCurveIsStraight) {
  EXPECT_TRUE(std::isinf(OddEvenInterpolator::maxStepLength(LogCurve(0, 100), kPaperScale, 0.01, 1e-6)));
  EXPECT_TRUE(std::isinf(OddEvenInterpolator::maxStepLength(LogCurve(10, 0), kPaperScale, 0.01, 1e-6)));
}

}  // namespace test_odd_even_interpolator
}  // namespace grinder
