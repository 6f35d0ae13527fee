// Set-ups of flutes against the ground cutter's sections, and brute force.

#include "tool/brute_force.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/setup/job_setup.h"

#include "jobs.h"
#include "random_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace grinder {
namespace test_flute_setup {

using brute::Shop;
using units::kDegree;
using units::kMillimetre;

constexpr Range kMachine{-60 * kDegree, 60 * kDegree};

std::vector<double> equalTeeth(int n) {
  std::vector<double> angles;
  for (int i = 0; i < n; ++i) angles.push_back(units::kTurn * i / n);
  return angles;
}

/// Asks for a core after a flute of a depth at the small end, as much thicker at the other end as the cone, with any
/// edge.
GrindJob jobFor(const Shop& s, int teeth = 2) {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  CutterGeometry& c = job.cutter;
  const double shank = c.shank_diameter;
  c = test_support::anyToolOf(s.tool().cutter, shank);
  c.core_diameter = c.end_diameter - 2 * s.depth * kMillimetre;
  c.core_diameter_end = c.core_diameter + 2 * c.flute_length * std::tan(c.cone_angle);
  c.core_tolerance = 0.05 * kMillimetre;
  c.shank_diameter = std::max(c.end_diameter, c.end_diameter + 2 * c.flute_length * std::tan(c.cone_angle));
  job.tooth_angles = equalTeeth(teeth);
  GrindProcess& p = job.process();
  p.wheel_diameter = s.wheel * kMillimetre;
  p.wheel_width = s.width * kMillimetre;
  p.depth = s.depth * kMillimetre;
  p.infeed = 30 * kMillimetre;
  p.overtravel_end = p.overtravel_shank = 0;
  return job;
}

/// The same with its spiral asked within half a degree.
GrindJob jobWithEdge(const Shop& s, int teeth = 2) {
  GrindJob job = jobFor(s, teeth);
  job.cutter.spiral_tolerance = 0.5 * kDegree;
  return job;
}

using Result = std::variant<JobSetup, std::string>;

bool isSet(const Result& result) {
  const auto* setup = std::get_if<JobSetup>(&result);
  return setup && setup->check.reasons.empty();
}

std::string whyNot(const Result& result) {
  const auto* setup = std::get_if<JobSetup>(&result);
  return setup ? text(setup->check.reasons) : std::get<std::string>(result);
}

JobSetup solved(const GrindJob& job, std::optional<SetupFigure> keep = std::nullopt) {
  const Result result = solveJobSetup(job, kMachine, keep);
  EXPECT_TRUE(isSet(result)) << whyNot(result);
  const auto* setup = std::get_if<JobSetup>(&result);
  return setup ? *setup : JobSetup{};
}

/// Measures the tool of a set-up by brute force: rake and core in five sections, and the edge's turn from the small
/// end to each.
void expectWithinTolerances(const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const brute::Bench bench = brute::benchOf(job, 120, 50);
  const double steepest = std::abs(c.spiral_angle) + c.spiral_tolerance;
  const double steeper = std::tan(std::min(steepest, 1.5)) / std::tan(std::abs(c.spiral_angle));
  const double start = bench.edge(0);
  for (int i = 0; i <= 4; ++i) {
    const double x = c.flute_length * i / 4;
    EXPECT_NEAR(bench.rake(x) / kDegree, c.rake_angle / kDegree, c.rake_tolerance / kDegree) << x;
    EXPECT_NEAR(2 * bench.core(x) / kMillimetre, askedCore(c, x) / kMillimetre, c.core_tolerance / kMillimetre) << x;
    const double turned = std::abs(bench.turned(x));
    EXPECT_NEAR(bench.edge(x) - start, bench.turned(x), turned * (steeper - 1) + 1e-9) << x;
  }
}

/// A tool whose rake, edge and cores are asked, within 0.5 deg and 0.05 mm, in the shop's units; a spiral below 0 is
/// left hand.
struct Asked {
  double diameter, cone, spiral, rake, length;
  int teeth;
  double core, core_end, wheel, width, wear, corner;
};

GrindJob jobFor(const Asked& a) {
  Shop shop{a.diameter, a.cone, a.spiral, a.rake, a.length, (a.diameter - a.core) / 2, a.wheel, a.width};
  if (a.spiral < 0) shop.cut = CutDirection::kLeftHand;
  GrindJob job = jobWithEdge(shop, a.teeth);
  job.cutter.core_diameter_end = a.core_end * kMillimetre;
  GrindProcess& p = job.process();
  p.wheel_wear = a.wear * kMillimetre;
  p.wheel_corner_radius_lower = p.wheel_corner_radius_upper = a.corner * kMillimetre;
  return job;
}

// Drawn at random. No set-up gives them exactly; another program found one within the tolerances for each.
TEST(FluteSetup, WhatCanBeHadWithinTheTolerancesIsFound) {
  const std::vector<Asked> cases{{2.04, 5.2, -24.2, 6.5, 3.34, 1, 1.59, 2.007, 50, 0.73, 0, 0},
                                 {1.77, 0.7, 39.2, 7, 4.42, 5, 1.427, 1.553, 75, 0.26, 0, 0.087},
                                 {7.59, 4.9, 44.9, 0.4, 18.34, 2, 5.631, 8.029, 50, 1.14, 0.041, 0},
                                 {17.12, 8.7, 24.6, 7.3, 25.1, 7, 14.283, 20.713, 75, 1.34, 0, 0},
                                 {1.05, 1.4, 42.6, 3.9, 1.53, 7, 0.831, 0.915, 50, 0.2, 0.048, 0},
                                 {8.6, 10.3, -36.1, 13.4, 17.67, 5, 6.91, 12.233, 50, 0.71, 0, 0.078},
                                 {2.66, -1.4, -47.5, 9.6, 4.57, 2, 1.822, 1.651, 50, 0.51, 0, 0},
                                 {12.1, 3.2, 24.3, 10.8, 20.92, 2, 8.067, 9.572, 75, 3.03, 0, 0}};
  const int count = std::min(test_support::randomCases(8), static_cast<int>(cases.size()));
  for (int i = 0; i < count; ++i) {
    const Asked& asked = cases[static_cast<std::size_t>(i)];
    SCOPED_TRACE(testing::Message() << "D " << asked.diameter << " mm, " << asked.spiral << " deg");
    expectWithinTolerances(solved(jobFor(asked)).job);
  }
}

double rakeError(const JobSetup& setup) {
  const GroundFigure rake = *find(setup.check.figures, ToolFigure::kRake);
  return std::max(rake.asked->from - rake.least.value, rake.largest.value - rake.asked->to);
}

// What is kept need not be exactly what the others take, and a machine that ends there is no worse than a kept swivel.
TEST(FluteSetup, WhatIsKeptOrAtItsEndIsMadeUpForByTheOthers) {
  const GrindJob cone = jobFor(Asked{5.45, -1.23, 30.4, 9.9, 15.8, 4, 3.7, 2.91, 75, 1.83, 0, 0});
  GrindJob job = solved(cone).job;
  job.process().setup_swivel -= 0.3 * kDegree;
  job.process().setup_height += 0.05 * kMillimetre;
  job.process().depth += 0.01 * kMillimetre;
  const GrindProcess kept = job.process();
  for (const auto& row : kSetupFigures) {
    SCOPED_TRACE(row.name);
    const JobSetup set = solved(job, row.value);
    const GrindProcess& p = set.job.process();
    const double moved[] = {p.setup_swivel - kept.setup_swivel, p.setup_height - kept.setup_height,
                            p.depth - kept.depth};
    EXPECT_EQ(moved[static_cast<std::size_t>(row.value)], 0);
    if (row.value != SetupFigure::kSwivel) continue;
    const auto at_end = std::get<JobSetup>(solveJobSetup(cone, {-60 * kDegree, kept.setup_swivel}, std::nullopt));
    EXPECT_LT(rakeError(at_end), rakeError(set) + 0.1 * kDegree);
    EXPECT_NEAR(at_end.job.process().setup_swivel, kept.setup_swivel, 0.51e-4 * kDegree);
  }
}

// The edge of this tool could be a facet, too.
TEST(FluteSetup, ASetUpWithoutAFacetIsBetter) {
  const GrindJob face =
      solved(jobFor(Asked{6.60692, 0, -1.59967, 14.4542, 13.0994, 4, 5.4931, 5.4931, 100, 2.02189, 0, 0.042296})).job;
  const brute::Bench bench = brute::benchOf(face, 120, 50);
  const double r = bench.radius(5e-3), h = 1e-5 * r, in = 0.998 * r;
  const double turn =
      bench.wall(5e-3, in - h, bench.rakeSide()).angle - bench.wall(5e-3, in + h, bench.rakeSide()).angle;
  EXPECT_NEAR(std::atan(in * turn / (2 * h)), bench.rake(5e-3), 2.2 * kDegree);
}

// The rake over the swivel is a tent whose peak, at the spiral angle, is the asked rake.
TEST(FluteSetup, ARakeThatIsJustTheMaxIsFound) {
  for (const double spiral : {0.0, 0.02}) {
    for (const double rake : {5.0, 8.0}) {
      const JobSetup setup = solved(jobFor(Shop{12, 0, spiral, rake, 20, 2, 100, 4}));
      EXPECT_NEAR(setup.job.process().setup_swivel / kDegree, spiral, 0.6);
      EXPECT_NEAR(find(setup.check.figures, ToolFigure::kRake)->least.value / kDegree, rake, 0.05);
    }
  }
}

TEST(FluteSetup, AStraightFluteOnAConeTakesNoShiftAndANearlyStraightOneALimitedShift) {
  for (const double spiral : {0.0, 0.02, -0.6}) {
    SCOPED_TRACE(spiral);
    const GrindJob job = solved(jobFor(Asked{12, 6, spiral, 5, 20, 2, 8.2, 12.404, 100, 4, 0, 0})).job;
    if (spiral == 0) {
      EXPECT_EQ(job.process().setup_x_shift, 0);
    }
    EXPECT_LT(std::abs(job.process().setup_x_shift), 50 * kMillimetre);
    EXPECT_TRUE(checkGroundCutter(ValidJob(job)).reasons.empty());
  }
}

TEST(FluteSetup, WithItsOvertravelTheFluteIsCompleteAndWithLessItIsNot) {
  for (const Shop& shop : {Shop{}, Shop{16, -1, 35, 8, 30, 2, 100, 3}}) {
    SCOPED_TRACE(shop.diameter);
    GrindJob job = solved(jobFor(shop)).job;
    const GroundCutter cutter = groundCutterOf(ValidJob(job));
    for (int i = 0; i <= 10; ++i) {
      EXPECT_TRUE(cutter.section(job.cutter.flute_length * i / 10).teeth[0].complete) << i;
    }
    if (shop.cone < 0) continue;
    job.process().overtravel_shank -= 0.2 * kMillimetre;
    EXPECT_FALSE(groundCutterOf(ValidJob(job)).section(job.cutter.flute_length).teeth[0].complete);
  }
}

// Found at random: a fit to rake, edge and core alone ends where the flutes meet.
TEST(FluteSetup, ALandIsLookedFor) {
  GrindJob job = jobWithEdge(Shop{1.38, 0, -22.3, 14.2, 3.37, 0.195, 75, 0.63}, 8);
  job.tooth_angles[1] += 0.5 * kDegree;
  job.process().depth_end = 0.2 * kMillimetre;
  const JobSetup setup = solved(job);
  const double land = find(setup.check.figures, ToolFigure::kLand)->least.value;
  EXPECT_GT(land, 0);
  EXPECT_EQ(setup.limit, SetupLimit::kLand);
  EXPECT_NEAR(setup.margin, land / (44.5 * kDegree * 0.69 * kMillimetre), 1e-9);
  EXPECT_EQ(setup.job.process().depth_end, 0);
  EXPECT_EQ(setup.job.process().setup_x_shift, 0);
  expectWithinTolerances(setup.job);
}

TEST(FluteSetup, WhatCannotBeHadComesWithThePlansReasonsAndAToolThatCan) {
  // With the wheel over the axis the core is least: 10 - 2 * 1.6.
  GrindJob job = jobFor(Shop{10, 0, 30, 8, 30, 1.6, 100, 6});
  job.cutter.core_diameter = job.cutter.core_diameter_end = 6.7 * kMillimetre;
  const Result result = solveJobSetup(job, kMachine, SetupFigure::kDepth);
  const auto* none = std::get_if<JobSetup>(&result);
  ASSERT_TRUE(none) << whyNot(result);
  EXPECT_EQ(none->check.reasons.at(0).kind, ReasonKind::kCoreSize);
  double core = 0, core_end = 0;
  ASSERT_EQ(std::sscanf(none->remedy.c_str(), "cutter.core_diameter_mm = %lf and cutter.core_diameter_end_mm = %lf",
                        &core, &core_end),
            2)
      << none->remedy;
  EXPECT_GE(core, 6.799);
  EXPECT_EQ(core_end, core);
  job.cutter.core_diameter = job.cutter.core_diameter_end = core * kMillimetre;
  expectWithinTolerances(solved(job, SetupFigure::kDepth).job);
}

GrindJob randomJob(int i, const std::function<double(double, double)>& uniform) {
  Shop shop;
  shop.diameter = uniform(3, 20);
  shop.cone = i % 4 == 0 ? 0 : uniform(-2, 10);
  shop.length = uniform(1, 3) * shop.diameter;
  if (shop.cone < 0) shop.length = std::min(shop.length, -0.4 * shop.diameter / 2 / std::tan(shop.cone * kDegree));
  shop.rake = uniform(0, 15);
  shop.cut = uniform(0, 1) < 0.5 ? CutDirection::kRightHand : CutDirection::kLeftHand;
  shop.spiral = uniform(5, 45) * (shop.cut == CutDirection::kRightHand ? 1 : -1);
  shop.depth = uniform(0.15, 0.5) * shop.diameter / 2;
  shop.wheel = uniform(50, 125);
  shop.width = uniform(0.1, 0.5) * shop.diameter;
  GrindJob job = jobFor(shop, 1 + static_cast<int>(uniform(0, 4)));
  job.cutter.core_tolerance = 0.2 * shop.diameter * kMillimetre;
  GrindProcess& p = job.process();
  p.wheel_corner_radius_lower = uniform(0, 0.2) * p.wheel_width;
  p.wheel_corner_radius_upper = uniform(0, 0.2) * p.wheel_width;
  if (i % 5 < 2) p.wheel_corner_radius_lower = p.wheel_corner_radius_upper = 0;
  if (i % 5 == 3) p.wheel_profile = WheelShape::kAngled, p.wheel_angle = uniform(1, 30) * kDegree;
  if (i % 5 == 4) {
    p.wheel_profile = WheelShape::kFullRadius;
    p.wheel_corner_radius_lower = p.wheel_corner_radius_upper = 0;
  }
  return job;
}

TEST(FluteSetup, RandomToolsAreSetWhereTheyCanBeHad) {
  std::mt19937 random(5);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const int cases = std::min(test_support::randomCases(8), 12);  // for these there is a set-up
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE(i);
    expectWithinTolerances(solved(randomJob(i, uniform)).job);
  }
}

}  // namespace test_flute_setup
}  // namespace grinder
