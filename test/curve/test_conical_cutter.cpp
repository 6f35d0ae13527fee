#include "flute_grinder/curve/conical_cutter.h"

#include "curve/generators.h"
#include "reference.h"
#include "refusal.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace grinder {
namespace test_conical_cutter {

using namespace test_support;

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// What is wrong with a cutter; empty where nothing is.
std::string errorOf(const Cone& geometry) {
  return test_support::refusalOf<std::invalid_argument>([&] { ConicalCutter cutter(geometry); });
}

RC_GTEST_PROP(ConicalCutterProperty, FollowsThePapersEquations, ()) {
  const Cone g = *test_support::cone();
  const ConicalCutter cutter(g);
  const double x = *uniform(-2e-3, g.flute_length);
  const Real tan_cone = std::tan(Real(g.cone_angle));
  const Real y = x * tan_cone;
  const Real z_per_y = test_support::zPerY(g);
  const Real z = y * z_per_y;
  RC_ASSERT(std::abs(cutter.y(x) - y) <= 4 * kEps * std::abs(y));
  RC_ASSERT(std::abs(cutter.z(x) - z) <= 8 * kEps * std::abs(z));
  RC_ASSERT(std::abs(cutter.radius(x) - (Real(g.end_diameter) / 2 + y)) <= 4 * kEps * (g.end_diameter + std::abs(y)));
  RC_ASSERT(std::abs(cutter.tanCone() - tan_cone) <= 4 * kEps * std::abs(tan_cone));
  RC_ASSERT(std::abs(cutter.tanSpiral() - std::tan(Real(g.spiral_angle))) <=
            4 * kEps * std::abs(std::tan(Real(g.spiral_angle))));
  RC_ASSERT(std::abs(cutter.zPerY() - z_per_y) <= 4 * kEps * std::abs(z_per_y));
}

RC_GTEST_PROP(ConicalCutterProperty, HelixStandsToTheGeneratrixAtItsAngle, ()) {
  const Cone g = *test_support::cone();
  const Real angle = std::atan(std::tan(Real(g.spiral_angle)) * std::cos(Real(g.cone_angle)));
  RC_ASSERT(std::abs(ConicalCutter(g).cosHelixToGeneratrix() - std::cos(angle)) <= 8 * kEps);
}

TEST(ConicalCutter, TakesFinitePositiveLengthsAndAnglesBelowARightAngle) {
  constexpr double kRight = 90 * units::kDegree;
  const std::vector<double> no_lengths{kNan, kInf, -kInf, 0, -0.0, -1e-3};
  const std::vector<double> no_angles{kNan, kInf, -kInf, kRight, -kRight, 2, -2, 100};
  const struct {
    const char* name;
    double Cone::*figure;
    const std::vector<double>& bad;
  } rows[]{{"end_diameter", &Cone::end_diameter, no_lengths},
           {"flute_length", &Cone::flute_length, no_lengths},
           {"cone_angle", &Cone::cone_angle, no_angles},
           {"spiral_angle", &Cone::spiral_angle, no_angles},
           {"rake_angle", &Cone::rake_angle, no_angles}};
  for (const auto& row : rows) {
    for (const double bad : row.bad) {
      Cone g = paperCone();
      g.*row.figure = bad;
      const std::string error = errorOf(g);
      EXPECT_NE(error.find(std::string("cutter.") + row.name + " = "), std::string::npos) << bad << ": " << error;
      EXPECT_NE(error.find("allowed: "), std::string::npos) << error;
    }
  }
}

TEST(ConicalCutter, StaysOpenUpToTheFlutesEnd) {
  // D1 2 mm at -3 deg closes at X = 19.08 mm.
  Cone g{2e-3, -3 * units::kDegree, 0.5, 0, 19.08e-3};
  EXPECT_EQ(errorOf(g), "");
  g.flute_length = 19.09e-3;
  EXPECT_NE(errorOf(g).find("cutter.cone_angle"), std::string::npos) << errorOf(g);
  EXPECT_NE(errorOf(g).find("close"), std::string::npos) << errorOf(g);
}

}  // namespace test_conical_cutter
}  // namespace grinder
