// Set-ups of flutes against the ground cutter's sections, and a search by brute force.

#include "tool/brute_force.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/setup/job_setup.h"

#include "jobs.h"
#include "random_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

brute::Tool toolOf(const GrindJob& job) {
  const GrindProcess& p = job.process();
  brute::Tool tool;
  tool.cutter = job.cutter;
  tool.teeth = job.tooth_angles.size();
  tool.wheel = wheelOf(job).worn(p.wheel_wear);
  tool.nominal_radius = p.wheel_diameter / 2 - p.wheel_wear;
  return tool;
}

/// Measures the tool of a set-up by brute force: rake and core in nine sections, and the edge's turn from the small
/// end to each.
void expectWithinTolerances(const GrindJob& job) {
  const brute::Tool tool = toolOf(job);
  const CutterGeometry& c = job.cutter;
  const GrindProcess& p = job.process();
  brute::Bench bench{tool, p.setup_swivel, p.setup_height, p.depth, 200, 100};
  bench.x_shift = p.setup_x_shift;
  bench.taper = (p.depth - p.depthEnd()) / c.flute_length;
  const double steepest = std::abs(c.spiral_angle) + c.spiral_tolerance;
  const double steeper = std::tan(std::min(steepest, 1.5)) / std::tan(std::abs(c.spiral_angle));
  for (int i = 0; i <= 8; ++i) {
    const double x = c.flute_length * i / 8;
    EXPECT_NEAR(bench.rake(x) / kDegree, c.rake_angle / kDegree, c.rake_tolerance / kDegree) << x;
    EXPECT_NEAR(2 * bench.core(x) / kMillimetre, askedCore(c, x) / kMillimetre, c.core_tolerance / kMillimetre) << x;
    const double turned = std::abs(bench.turned(x));
    EXPECT_NEAR(bench.edge(x) - bench.edge(0), bench.turned(x), turned * (steeper - 1) + 1e-9) << x;
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
                                 {4.25, 7.4, 41.3, 12.3, 9.29, 7, 3.504, 5.454, 100, 0.4, 0, 0},
                                 {1.48, 7.8, 22.8, 9.2, 3.7, 5, 1.177, 1.957, 50, 0.21, 0, 0},
                                 {5.08, 2.7, 36.3, 6.4, 6.8, 5, 3.751, 4.233, 50, 0.44, 0, 0},
                                 {17.12, 8.7, 24.6, 7.3, 25.1, 7, 14.283, 20.713, 75, 1.34, 0, 0},
                                 {1.05, 1.4, 42.6, 3.9, 1.53, 7, 0.831, 0.915, 50, 0.2, 0.048, 0},
                                 {1.82, 4.8, 36.5, 1.6, 4.55, 8, 1.519, 2.142, 75, 0.2, 0, 0},
                                 {3.04, 2.9, 11, 5.8, 7.35, 2, 2.183, 2.721, 75, 0.87, 0, 0},
                                 {8.6, 10.3, -36.1, 13.4, 17.67, 5, 6.91, 12.233, 50, 0.71, 0, 0.078},
                                 {16.61, 0.6, 24.7, 11.5, 32, 4, 12.87, 13.303, 75, 3.25, 0, 0.054},
                                 {2.66, -1.4, -47.5, 9.6, 4.57, 2, 1.822, 1.651, 50, 0.51, 0, 0},
                                 {12.1, 3.2, 24.3, 10.8, 20.92, 2, 8.067, 9.572, 75, 3.03, 0, 0}};
  const int count = std::min(test_support::randomCases(14), static_cast<int>(cases.size()));
  for (int i = 0; i < count; ++i) {
    const Asked& asked = cases[static_cast<std::size_t>(i)];
    SCOPED_TRACE(testing::Message() << "D " << asked.diameter << " mm, " << asked.spiral << " deg");
    expectWithinTolerances(solved(jobFor(asked)).job);
  }
}

// What is kept need not be exactly what the others take.
TEST(FluteSetup, AnyFigureIsKeptAsFarAsTheTolerancesGo) {
  const GrindJob cone = jobFor(Asked{10, 5, 30, 8, 30, 1, 6.8, 12.05, 100, 3, 0, 0});
  const GrindJob cylinder = jobWithEdge({10, 0, 30, 8, 30, 1.5, 100, 6});
  for (const GrindJob& asked : {cone, cylinder}) {
    GrindJob job = solved(asked).job;
    job.process().setup_swivel += 0.05 * kDegree;
    job.process().setup_height += 0.05 * kMillimetre;
    job.process().depth += 0.01 * kMillimetre;
    const GrindProcess kept = job.process();
    for (const auto& row : kSetupFigures) {
      SCOPED_TRACE(row.name);
      const GrindJob set = solved(job, row.value).job;
      expectWithinTolerances(set);
      const GrindProcess& p = set.process();
      const double moved[] = {p.setup_swivel - kept.setup_swivel, p.setup_height - kept.setup_height,
                              p.depth - kept.depth};
      EXPECT_EQ(moved[static_cast<std::size_t>(row.value)], 0);
    }
  }
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
  for (const double spiral : {0.0, 0.02, -0.02}) {
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
  int shortened = 0;
  for (const Shop& shop : {Shop{}, Shop{5, 10, 20, 14, 15, 0.7, 75, 1.5}, Shop{16, -1, 35, 8, 30, 2, 100, 3}}) {
    SCOPED_TRACE(shop.diameter);
    const JobSetup setup = solved(jobFor(shop));
    const double length = setup.job.cutter.flute_length;
    const GroundCutter cutter = groundCutterOf(ValidJob(setup.job));
    for (int i = 0; i <= 10; ++i) EXPECT_TRUE(cutter.section(length * i / 10).teeth[0].complete) << i;
    GrindJob shorter = setup.job;
    double& overtravel = shop.cone > 0 ? shorter.process().overtravel_shank : shorter.process().overtravel_end;
    if (overtravel == 0) continue;
    ++shortened;
    overtravel -= 0.2 * kMillimetre;
    EXPECT_FALSE(groundCutterOf(ValidJob(shorter)).section(shop.cone > 0 ? length : 0).teeth[0].complete);
  }
  EXPECT_GT(shortened, 0);
}

// Found at random: a fit to rake, edge and core alone ends where the flutes meet.
TEST(FluteSetup, ALandIsLookedFor) {
  const JobSetup setup = solved(jobWithEdge(Shop{1.38, 0, -22.3, 14.2, 3.37, 0.195, 75, 0.63}, 8));
  EXPECT_GT(find(setup.check.figures, ToolFigure::kLand)->least.value, 0);
  expectWithinTolerances(setup.job);
}

TEST(FluteSetup, ASwivelBeyondTheMachinesRangeIsNamed) {
  for (const int hand : {1, -1}) {
    Shop shop;
    shop.spiral *= hand;
    if (hand < 0) shop.cut = CutDirection::kLeftHand;
    const Range machine = hand > 0 ? Range{-60 * kDegree, 29 * kDegree} : Range{-29 * kDegree, 60 * kDegree};
    const std::string refusal = whyNot(solveJobSetup(jobWithEdge(shop), machine, std::nullopt));
    EXPECT_NE(refusal.find(hand > 0 ? "takes a swivel of 3" : "takes a swivel of -3"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(hand > 0 ? "-60 to 29 deg" : "-29 to 60 deg"), std::string::npos) << refusal;
  }
}

TEST(FluteSetup, WhatCannotBeHadComesWithThePlansReasons) {
  const auto refused = [](const GrindJob& job, ReasonKind kind, std::optional<SetupFigure> keep = std::nullopt) {
    const Result result = solveJobSetup(job, kMachine, keep);
    const auto* setup = std::get_if<JobSetup>(&result);
    const auto is_of_kind = [kind](const Reason& reason) { return reason.kind == kind; };
    EXPECT_TRUE(setup && std::any_of(setup->check.reasons.begin(), setup->check.reasons.end(), is_of_kind))
        << whyNot(result);
  };
  // The flute takes 48.6 deg at the small end, of a pitch of 45.
  refused(jobFor(Shop{}, 8), ReasonKind::kLand);
  // With the wheel over the axis the core is least: 10 - 2 * 1.6.
  GrindJob job = jobFor(Shop{10, 0, 30, 8, 30, 1.6, 100, 6});
  job.cutter.core_diameter = job.cutter.core_diameter_end = 6.7 * kMillimetre;
  refused(job, ReasonKind::kCoreSize, SetupFigure::kDepth);
  job.cutter.core_tolerance = 0.12 * kMillimetre;
  expectWithinTolerances(solved(job, SetupFigure::kDepth).job);
  refused(jobFor(Shop{10, 5, 30, 44}), ReasonKind::kRake);
}

/// The best set-up for the rake that a coarse search by brute force finds: over swivel and face height, on a cylinder
/// over the swivel.
class CoarseSearch {
 public:
  explicit CoarseSearch(const GrindJob& job)
      : tool_(toolOf(job)), core_(job.cutter.core_diameter / 2), right_(job.cutter.cut == CutDirection::kRightHand) {}

  struct Found {
    double error, swivel, face;
  };

  brute::Bench bench(double swivel, double face) const {
    const double upper = right_ ? tool_.wheel.upperFace() : tool_.wheel.lowerFace();
    const double height = face - upper / std::cos(swivel);
    return {tool_, swivel, height, brute::Bench::depthFor(tool_, swivel, height, core_, 40, 8)};
  }

  Found best() const {
    constexpr int kSteps = 16, kStarts = 4;
    std::vector<Found> grid;
    const double width = kMachine.to - kMachine.from;
    for (int i = 0; i <= kSteps; ++i) {
      for (int k = 0; k <= kSteps; ++k) {
        const double swivel = kMachine.from + width * i / kSteps, face = highest(swivel) * (2.0 * k / kSteps - 1);
        grid.push_back({error(swivel, face), swivel, face});
      }
    }
    std::sort(grid.begin(), grid.end(), [](const Found& a, const Found& b) { return a.error < b.error; });
    Found best = grid[0];
    for (int i = 0; i < kStarts; ++i) {
      const Found found = descend(grid[static_cast<std::size_t>(i)], width / kSteps);
      if (found.error < best.error) best = found;
    }
    return best;
  }

  double error(double swivel, double face) const {
    const brute::Bench b = bench(swivel, face);
    return b.depth > 0 && b.depth < tool_.cutter.end_diameter / 2 ? b.rakeError()
                                                                  : std::numeric_limits<double>::infinity();
  }

 private:
  double highest(double swivel) const {
    const double radius = tool_.cutter.end_diameter / 2;
    return radius + std::sqrt(2 * tool_.nominal_radius * (radius - core_)) * std::abs(std::sin(swivel));
  }

  Found descend(Found at, double step) const {
    double rise = highest(at.swivel) / 8;
    while (step > 1e-5) {
      bool better = false;
      for (int i = 0; i < 8 && !better; ++i) {
        const double swivel = at.swivel + step * std::cos(i * units::kPi / 4);
        const double face = at.face + rise * std::sin(i * units::kPi / 4);
        if (swivel < kMachine.from || swivel > kMachine.to) continue;
        const double e = error(swivel, face);
        if (e < at.error) at = {e, swivel, face}, better = true;
      }
      if (!better) step /= 2, rise /= 2;
    }
    return at;
  }

  const brute::Tool tool_;
  double core_;
  bool right_;
};

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

// A set-up is none if the rake is lost within what the swivel may be off, as beside the cliff where it meets the helix.
constexpr double kHandTight = 0.1 * kDegree, kUsable = 0.5 * kDegree;

TEST(FluteSetup, RandomToolsAreSetOrRefusedAsBruteForceConfirms) {
  std::mt19937 random(5);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int count = 0;
  const int cases = test_support::randomCases(12);
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE(i);
    const GrindJob job = randomJob(i, uniform);
    const Result result = solveJobSetup(job, kMachine, std::nullopt);
    if (isSet(result)) {
      ++count;
      expectWithinTolerances(std::get<JobSetup>(result).job);
      continue;
    }
    const CoarseSearch search(job);
    const auto found = search.best();
    if (found.error > 0.01 * kDegree) continue;
    if (!(search.error(found.swivel - kHandTight, found.face) < kUsable)) continue;
    if (!(search.error(found.swivel + kHandTight, found.face) < kUsable)) continue;
    EXPECT_FALSE(search.bench(found.swivel, found.face).land() > 0)
        << whyNot(result) << ", yet at swivel " << found.swivel / kDegree << " deg, face " << found.face / kMillimetre
        << " mm the rake is off by " << found.error / kDegree << " deg";
  }
  EXPECT_GT(count, cases / 3);
}

}  // namespace test_flute_setup
}  // namespace grinder
