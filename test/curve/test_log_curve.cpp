#include "flute_grinder/curve/log_curve.h"

#include "curve/generators.h"
#include "reference.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace grinder {
namespace test_log_curve {

using namespace test_support;

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// The curve with the reference's b and k rounded, so that only the functions are compared.
struct Curves {
  LogCurve curve;
  ReferenceCurve reference;
  double shortest, longest;  ///< X over which it exists with a fifth of its radius

  static Curves draw() {
    const Cone g = *test_support::cone();
    const LogCurve curve{ConicalCutter(g)};
    return {curve, ReferenceCurve(curve.b(), curve.k()), -test_support::openLength(g, -1, 10e-3), g.flute_length};
  }
};

// Closed form, with the curve's own constants: A(X - shift).
TEST(LogCurve, WithAShiftItIsTheCurveThere) {
  Cone back = test_support::paperCone(), cylinder = back;
  back.cone_angle = -3 * units::kDegree;
  cylinder.cone_angle = 0;
  for (const Cone& geometry : {test_support::paperCone(), back, cylinder}) {
    const LogCurve curve{ConicalCutter(geometry)};
    for (const double x_shift : {-8e-3, 0.0, 11.847e-3}) {
      const LogCurve ahead(ConicalCutter(geometry), x_shift);
      for (const double x : {-5e-3, 0.0, 12e-3, 30e-3}) {
        EXPECT_NEAR(ahead.a(x), curve.a(x - x_shift), 4e-15) << x_shift << ' ' << x;
        EXPECT_NEAR(ahead.slope(x), curve.slope(x - x_shift), 1e-12) << x_shift << ' ' << x;
      }
    }
  }
}

RC_GTEST_PROP(LogCurveProperty, IsTheLogarithmInLongDouble, ()) {
  const Curves c = Curves::draw();
  const double x = *uniform(c.shortest, c.longest);
  const Real expected = c.reference.a(x);
  RC_ASSERT(std::abs(c.curve.a(x) - expected) <= 6 * kEps * std::abs(expected));
}

RC_GTEST_PROP(LogCurveProperty, HasTheConstantsOfTheCutter, ()) {
  const Cone g = *test_support::cone();
  const LogCurve curve{ConicalCutter(g)};
  const ReferenceCurve reference(g);
  RC_ASSERT(std::abs(curve.b() - reference.b) <= 4 * kEps * std::abs(reference.b));
  RC_ASSERT(std::abs(curve.k() - reference.k) <= 4 * kEps * std::abs(reference.k));
}

RC_GTEST_PROP(LogCurveProperty, DeltaIsTheDifferenceAlsoOfCloseNeighbours, ()) {
  const Curves c = Curves::draw();
  const double x = *uniform(c.shortest, c.longest);
  const double end = *uniform(c.shortest, c.longest);
  const double dx = (end - x) * *test_support::logUniform(1e-12, 1);
  const Real expected = c.reference.delta(x, dx);
  // 1e-15 where the path goes, plus what rounding u(x) makes of 1 + bX where the radius nearly vanishes.
  const Real u = c.reference.u(x);
  const Real tolerance = Real(1e-15) + 2 * kEps * (1 + std::abs(c.reference.b * x)) / u +
                         2 * kEps * (1 + std::abs(c.reference.b * x)) / c.reference.u(x + dx);
  RC_ASSERT(std::abs(c.curve.delta(x, dx) - expected) <= tolerance * std::abs(expected));
}

RC_GTEST_PROP(LogCurveProperty, SlopeIsTheDerivative, ()) {
  const Curves c = Curves::draw();
  const double x = *uniform(c.shortest, c.longest);
  const Real u = c.reference.u(x);
  const Real expected = c.reference.k / u;
  RC_ASSERT(std::abs(c.curve.slope(x) - expected) <=
            kEps * (2 + 2 * (1 + std::abs(c.reference.b * x)) / u) * std::abs(expected));
  RC_ASSERT(std::abs(c.curve.u(x) - u) <= 2 * kEps * (1 + std::abs(c.reference.b * x)));
}

}  // namespace test_log_curve
}  // namespace grinder
