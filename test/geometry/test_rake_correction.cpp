// The correction of Z: its derivatives, and the rake that is ground with it.

#include "brute_force.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/rake_correction.h"
#include "flute_grinder/geometry/setup_solver.h"

#include <gtest/gtest.h>

#include <cmath>

namespace grinder {
namespace test_rake_correction {

using units::kDegree;
using units::kMillimetre;

TEST(ZCorrection, ItIsSmoothUpToTheThirdDerivativeWhichBelongsToZ) {
  ZCorrection c;
  c.from = -2;
  c.piece = 1.5;
  c.pieces = 6;
  for (int i = 0; i < c.coefficientCount(); ++i) c.coefficients[static_cast<std::size_t>(i)] = std::sin(2.0 * i * i);
  for (int i = 1; i < c.pieces; ++i) {
    const double knot = c.from + i * c.piece;
    const auto before = c.at(knot - 1e-9), after = c.at(knot + 1e-9);
    EXPECT_NEAR(before.z, after.z, 1e-7);
    EXPECT_NEAR(before.first, after.first, 1e-7);
    EXPECT_NEAR(before.second, after.second, 1e-7);
    EXPECT_NEAR(before.third, after.third, 1e-7);
  }
  for (double x = -3; x < 8; x += 0.37) {
    constexpr double kStep = 1e-5;
    const auto a = c.at(x - kStep), b = c.at(x + kStep), v = c.at(x);
    EXPECT_NEAR((b.z - a.z) / (2 * kStep), v.first, 1e-6) << x;
    EXPECT_NEAR((b.first - a.first) / (2 * kStep), v.second, 1e-6) << x;
    EXPECT_NEAR((b.second - a.second) / (2 * kStep), v.third, 1e-6) << x;
  }
}

TEST(ZCorrection, OutsideItsRangeItStaysAsAtTheEnds) {
  ZCorrection c;
  c.from = 1;
  c.piece = 0.5;
  c.pieces = 4;
  for (int i = 0; i < c.coefficientCount(); ++i) c.coefficients[static_cast<std::size_t>(i)] = std::sin(2.0 * i * i);
  for (const double end : {1.0, 3.0}) {
    for (const double beyond : {1e-9, 0.2, 30.0}) {
      const auto v = c.at(end == 1 ? end - beyond : end + beyond);
      EXPECT_DOUBLE_EQ(v.z, c.at(end).z);
      EXPECT_EQ(v.first, 0);
      EXPECT_EQ(v.second, 0);
      EXPECT_EQ(v.third, 0);
    }
  }
}

SetupRequest requestFor(double diameter, double cone, double spiral, double rake, double length, double depth,
                        double wheel, double width) {
  SetupRequest r;
  r.cutter = {diameter * kMillimetre, cone * kDegree, spiral * kDegree, rake * kDegree, length * kMillimetre};
  r.cutter.cut = spiral < 0 ? CutDirection::kLeftHand : CutDirection::kRightHand;
  r.rake = rake * kDegree;
  r.tooth_angles = {0};
  r.wheel = WheelProfile::straight(wheel * kMillimetre, width * kMillimetre);
  r.nominal_radius = wheel / 2 * kMillimetre;
  r.depth = depth * kMillimetre;
  r.min_swivel = -60 * kDegree;
  r.max_swivel = 60 * kDegree;
  return r;
}

TEST(RakeCorrection, TheRakeIsTheSameOverTheWholeFlute) {
  for (const SetupRequest& request :
       {requestFor(10, 5, 30, 8, 30, 1.6, 100, 3), requestFor(5, 10, 20, 14, 15, 0.7, 75, 1.5),
        requestFor(6, 7, -25, 12, 20, 0.9, 80, 2), requestFor(16, -1, 35, 8, 30, 2, 100, 3)}) {
    const auto solved = std::get<SolvedSetup>(solveSetup(request));
    const ConicalCutter cutter(request.cutter);
    const double length = request.cutter.flute_length;
    GrindStroke stroke{-solved.overtravel[0], length + solved.overtravel[1], -solved.depth, 0, 0, {}};
    const auto corrected =
        correctRake(cutter, request.wheel, request.nominal_radius, solved.setup, stroke, request.rake);
    ASSERT_TRUE(corrected.has_value());
    EXPECT_NEAR(corrected->min_rake, request.rake, 0.005 * kDegree);
    EXPECT_NEAR(corrected->max_rake, request.rake, 0.005 * kDegree);
    // In other sections than those it was made for, by sections and by brute force.
    stroke.z_correction = corrected->z;
    const GroundCutter ground(
        cutter, {{WheelSweep(cutter, request.wheel, request.nominal_radius, solved.setup, stroke)}}, {{}});
    brute::Bench bench{request, solved.setup.swivel, solved.setup.height, solved.depth, 800, 100};
    bench.z_correction = corrected->z;
    for (const double part : {0.0, 0.017, 0.231, 0.522, 0.871, 1.0}) {
      EXPECT_NEAR(*ground.section(part * length).teeth[0].rake, request.rake, 0.005 * kDegree) << part;
      EXPECT_NEAR(bench.rake(part * length), request.rake, 0.005 * kDegree) << part;
    }
  }
}

TEST(RakeCorrection, WhereThereIsNoFluteThereIsNoCorrection) {
  const SetupRequest request = requestFor(10, 5, 30, 8, 30, 1.6, 100, 3);
  const WheelSetup above{request.min_swivel, 0.1};
  EXPECT_FALSE(correctRake(ConicalCutter(request.cutter), request.wheel, request.nominal_radius, above,
                           {0, 0.03, -0.0016, 0, 0, {}}, request.rake)
                   .has_value());
}

}  // namespace test_rake_correction
}  // namespace grinder
