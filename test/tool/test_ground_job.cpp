// From a job to the cutter that it grinds, and the checks of a plan.

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/ground_tool.h"

#include "brute_force.h"
#include "jobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace grinder {
namespace test_ground_job {

using test_support::jobOf;
using test_support::paper;
using units::kDegree;
using units::kMillimetre;
using units::kPi;

CutterCheck checked(const GrindJob& job) { return checkGroundCutter(ValidJob(job)); }

/// The one reason of a kind.
Reason reasonOf(const CutterCheck& check, ReasonKind kind) {
  Reason found;
  int count = 0;
  for (const Reason& reason : check.reasons) {
    if (reason.kind == kind) found = reason, ++count;
  }
  EXPECT_EQ(count, 1) << text(check.reasons);
  return found;
}

/// A cylinder of the design's table: D 10, S 30, rake 8, depth 1.6, straight wheel 100 x 6, its face at R sin r.
GrindJob cylinder(double swivel_deg) {
  GrindJob job = paper();
  job.cutter.cone_angle = 0;
  job.process().wheel_width = 6 * kMillimetre;
  job.process().setup_swivel = swivel_deg * kDegree;
  job.process().setup_height =
      job.cutter.end_diameter / 2 * std::sin(job.cutter.rake_angle) - 3 * kMillimetre / std::cos(swivel_deg * kDegree);
  job.process().overtravel_end = job.process().overtravel_shank = 8 * kMillimetre;
  return job;
}

TEST(GroundJob, AShippedJobGrindsTheToolThatItAsksFor) {
  for (const char* entry : {"unequal_d12_t4", "left_hand_d8_t3"}) {
    SCOPED_TRACE(entry);
    const GrindJob job = jobOf(entry);
    const GroundCutter cutter = groundCutterOf(ValidJob(job));
    const CutterCheck check = checked(job);
    EXPECT_TRUE(check.reasons.empty()) << text(check.reasons);
    ASSERT_TRUE(check.complete.has_value());
    EXPECT_EQ(check.complete->from, 0);
    EXPECT_EQ(check.complete->to, job.cutter.flute_length);
    double min_rake = 90 * kDegree, max_spiral = -90 * kDegree;
    for (int i = 0; i <= 16; ++i) {
      for (const ToothSection& tooth : cutter.section(i / 16.0 * job.cutter.flute_length).teeth) {
        ASSERT_TRUE(tooth.rake && tooth.land && tooth.complete);
        EXPECT_NEAR(*tooth.rake, job.cutter.rake_angle, job.cutter.rake_tolerance);
        if (i % 2 != 0) continue;  // between the checked sections
        min_rake = std::min(min_rake, *tooth.rake);
        max_spiral = std::max(max_spiral, tooth.spiral.value());
      }
    }
    const auto figure = [&](ToolFigure which) { return *find(check.figures, which); };
    EXPECT_NEAR(figure(ToolFigure::kRake).least.value, min_rake, 1e-4);  // with other wear
    EXPECT_NEAR(figure(ToolFigure::kSpiral).largest.value, max_spiral, 1e-4);
    for (const auto& at : {figure(ToolFigure::kCoreDiameter).least, figure(ToolFigure::kCoreDiameter).largest}) {
      EXPECT_NEAR(at.value, 2 * cutter.section(at.x).core_radius, 1e-8);
    }
  }
}

TEST(GroundJob, EdgesAreWhereTheWheelFormsThem) {
  constexpr double kLinear = 5e-6;  // between the sections that are known
  for (const std::string& entry : test_support::shippedJobs()) {
    GrindJob job = readJobFile(entry, "flute");
    job.process().wheel_wear = job.process().wheel_wear_per_pass = 0;
    const CutterCheck check = checkGroundCutter(ValidJob(job));
    ASSERT_EQ(check.edges.size(), job.tooth_angles.size());
    for (std::size_t tooth = 0; tooth < check.edges.size(); ++tooth) {
      const GroundEdge& edge = check.edges[tooth];
      EXPECT_EQ(edge.from(), 0);
      EXPECT_EQ(edge.to(), job.cutter.flute_length);
      brute::Bench bench = brute::benchOf(job, 0, 0);
      bench.tool.cutter = ValidJob(job).cutterOf(static_cast<int>(tooth));
      for (int i = 0; i <= 21; ++i) {
        SCOPED_TRACE(::testing::Message() << entry << " tooth " << tooth << " place " << i);
        const GroundEdge::Place at = edge.at(i / 21.0 * job.cutter.flute_length);
        EXPECT_NEAR(edge.formedAt(at.wheel_x).x, at.x, 1e-12);
        // In the machine while the wheel is there.
        const double angle = at.turn + bench.turned(at.wheel_x - bench.x_shift);
        const auto depth = [&](double s) { return bench.depthOf(at.x, bench.radius(at.x), angle, s); };
        EXPECT_NEAR(depth(at.wheel_x), 0, kLinear);
        for (double off = -3e-3; off < 3.1e-3; off += 0.5e-3) EXPECT_LT(depth(at.wheel_x + off), kLinear) << off;
      }
    }
  }
}

TEST(GroundJob, TheToleranceDecidesWhichRakeWillDo) {
  const Reason reason = reasonOf(checked(cylinder(30)), ReasonKind::kRake);  // swivelled to the spiral angle
  EXPECT_NEAR(reason.value / kDegree, 25.420, 0.002);
  EXPECT_DOUBLE_EQ(reason.limit, 8 * kDegree);
  EXPECT_EQ(reason.x, 0);
  GrindJob job = cylinder(38);  // 7.886 deg
  for (const double tolerance : {0.115, 0.113}) {
    job.cutter.rake_tolerance = tolerance * kDegree;
    EXPECT_EQ(checked(job).reasons.empty(), tolerance > 0.114);
  }
}

TEST(GroundJob, AChordOffByMoreThanItsToleranceIsRefused) {
  GrindJob job = cylinder(38);
  const double off = std::abs(*groundCutterOf(ValidJob(job)).section(0).teeth[0].chordal_rake - 8 * kDegree);
  job.cutter.chordal_rake_tolerance = 1.001 * off;
  EXPECT_TRUE(checked(job).reasons.empty());
  job.cutter.chordal_rake_tolerance = 0.999 * off;
  const Reason reason = reasonOf(checked(job), ReasonKind::kChordalRake);
  EXPECT_NEAR(std::abs(reason.value - 8 * kDegree), off, 1e-9);
  EXPECT_DOUBLE_EQ(reason.limit, 8 * kDegree);
}

// By the published motion the paper's cutter gets an edge of 26.8 to 27.9 deg in place of 30.
TEST(GroundJob, AnEdgeOffItsHelixByMoreThanItsToleranceIsRefused) {
  GrindJob job = paper();
  job.cutter.spiral_tolerance = 3.5 * kDegree;
  EXPECT_TRUE(checked(job).reasons.empty());
  job.cutter.spiral_tolerance = 3 * kDegree;
  EXPECT_NEAR(reasonOf(checked(job), ReasonKind::kSpiral).value / kDegree, 26.9, 0.11);
}

TEST(GroundJob, AFluteThatIsNotCompleteIsRefusedUnlessTheJobAllowsIt) {
  GrindJob job = paper();
  job.process().overtravel_shank = 1 * kMillimetre;
  CutterCheck check = checked(job);
  const Reason reason = reasonOf(check, ReasonKind::kIncomplete);
  EXPECT_EQ(reason.low, 0);
  EXPECT_EQ(reason.limit, job.cutter.flute_length);
  ASSERT_TRUE(check.complete.has_value());
  EXPECT_EQ(check.complete->to, reason.value);
  // A longer stroke changes nothing up to there, and something behind.
  GrindJob longer = job;
  longer.process().overtravel_shank = 10 * kMillimetre;
  const GroundCutter ground = groundCutterOf(ValidJob(job)), whole = groundCutterOf(ValidJob(longer));
  const double inside = check.complete->to - 0.05 * kMillimetre, behind = check.complete->to + 0.5 * kMillimetre;
  EXPECT_NEAR(*ground.section(inside).teeth[0].rake, *whole.section(inside).teeth[0].rake, 1e-6);
  EXPECT_NEAR(ground.areaRemoved(ground.section(inside)), whole.areaRemoved(whole.section(inside)), 1e-12);
  EXPECT_LT(ground.areaRemoved(ground.section(behind)), whole.areaRemoved(whole.section(behind)));

  job.process().incomplete_ok = true;
  check = checked(job);
  EXPECT_TRUE(check.reasons.empty()) << text(check.reasons);
  EXPECT_LT(check.complete->to, job.cutter.flute_length);
  // It allows one that is complete nowhere, but none that is too deep.
  job.cutter.flute_length = 3 * kMillimetre;
  job.process().overtravel_end = job.process().overtravel_shank = 0;
  check = checked(job);
  EXPECT_FALSE(check.complete.has_value());
  EXPECT_TRUE(check.reasons.empty()) << text(check.reasons);
  job.cutter.core_tolerance = 0.02 * kMillimetre;
  job.cutter.core_diameter = job.cutter.core_diameter_end = job.cutter.end_diameter - job.process().depth;
  EXPECT_LT(reasonOf(checked(job), ReasonKind::kCoreSize).value, job.cutter.core_diameter);
}

// Straight slots, 3 mm wide and to 2.5 mm from the axis: eight of them leave 15 deg on the circle of 12 mm, and meet
// below it. At the floor's corner each takes atan(3 / 2.5).
TEST(GroundJob, FlutesThatMeetBelowTheLandAreRefused) {
  GrindJob job = jobOf("roughing_d10_t4");
  job.cutter.end_diameter = job.cutter.shank_diameter = 12 * kMillimetre;
  job.cutter.core_diameter = job.cutter.core_diameter_end = 5 * kMillimetre;
  job.cutter.spiral_angle = job.cutter.rake_angle = 0;
  job.process().depth = 3.5 * kMillimetre;
  job.process().setup_swivel = 0;
  job.process().setup_height = -1.5 * kMillimetre;
  const auto withTeeth = [&](int teeth) {
    job.tooth_angles.clear();
    for (int i = 0; i < teeth; ++i) job.tooth_angles.push_back(2 * kPi * i / teeth);
    return checked(job);
  };
  for (const CutDirection cut : {CutDirection::kRightHand, CutDirection::kLeftHand}) {
    job.cutter.cut = cut;
    job.process().setup_height = (cut == CutDirection::kRightHand ? -1.5 : 1.5) * kMillimetre;
    EXPECT_TRUE(withTeeth(6).reasons.empty()) << text(withTeeth(6).reasons);
    const Reason reason = reasonOf(withTeeth(8), ReasonKind::kLand);
    EXPECT_NEAR(reason.limit, kPi / 4, 1e-12);
    EXPECT_GT(reason.value, reason.limit);
    EXPECT_LE(reason.value, std::atan2(3, 2.5));
    // Whichever way it is to the next tooth.
    for (const double narrow : {20.0, 340.0}) {
      job.tooth_angles = {0, narrow * kDegree};
      const Reason of_two = reasonOf(checked(job), ReasonKind::kLand);
      EXPECT_NEAR(of_two.limit, 20 * kDegree, 1e-12);
      EXPECT_EQ(of_two.tooth, (cut == CutDirection::kRightHand) == (narrow < 180) ? 0 : 1);
    }
  }
}

TEST(GroundJob, CornersThatDoNotFitAreRefused) {
  GrindJob job = paper();
  job.process().wheel_profile = WheelShape::kPoints;
  job.process().wheel_points = {{-1.5e-3, 50e-3}, {-1.4e-3, 49e-3}, {1.5e-3, 50e-3}};
  job.process().wheel_corner_radius_lower = 1 * kMillimetre;
  const CutterCheck check = checked(job);
  EXPECT_NE(text(check.reasons).find("corner_radius"), std::string::npos);
}

TEST(GroundJob, EveryToothIsGroundByTheWheelAsWornInItsDeepestPass) {
  GrindJob job = jobOf("roughing_d10_t4");
  job.process().wheel_wear_per_pass = 0.05 * kMillimetre;
  job.process().wheel_wear = 1 * kMillimetre;
  const GroundSection section = groundCutterOf(ValidJob(job)).section(0.01);
  // Depths 0.4, 0.8, 1.2, 1.55, 1.6 and 1.6 mm: the fifth of six passes of a tooth is its deepest.
  for (std::size_t i = 0; i < 4; ++i) {
    GrindJob one = job;
    one.tooth_angles = {0};
    one.process().wheel_wear_per_pass = 0;
    one.process().wheel_wear = 1 * kMillimetre + static_cast<double>(6 * i + 4) * 0.05 * kMillimetre;
    const ToothSection alone = groundCutterOf(ValidJob(one)).section(0.01).teeth[0];
    EXPECT_DOUBLE_EQ(*section.teeth[i].rake, *alone.rake);
    EXPECT_DOUBLE_EQ(section.teeth[i].depth, alone.depth);
  }
  EXPECT_NE(*section.teeth[0].rake, *section.teeth[3].rake);
}

TEST(GroundJob, AToothWithAHelixOfItsOwnHasItsSpiralAngle) {
  GrindJob job = cylinder(38);
  job.process().wheel_width = 2 * kMillimetre;
  job.process().setup_height += 2 * kMillimetre / std::cos(38 * kDegree);
  job.tooth_angles = {0, 180 * kDegree};
  job.spiral_angles = {30 * kDegree, 33 * kDegree};
  ASSERT_TRUE(validate(job).empty());
  const GroundSection section = groundCutterOf(ValidJob(job)).section(0.015);
  EXPECT_NEAR(*section.teeth[0].spiral, 30 * kDegree, 1e-4);
  EXPECT_NEAR(*section.teeth[1].spiral, 33 * kDegree, 1e-4);
}

// The published motion grinds the paper's cutter with a spiral of 27 deg.
TEST(GroundJob, TheEdgeIsComparedWithTheAskedHelix) {
  GrindJob job = jobOf("paper");
  const brute::Bench bench = brute::benchOf(job, 200, 100);
  double min = 1e9, max = -1e9;
  for (int i = 0; i <= 8; ++i) {
    const double x = job.cutter.flute_length * i / 8, off = bench.edge(x) - bench.turned(x);
    min = std::min(min, off), max = std::max(max, off);
  }
  const CutterCheck check = checkGroundCutter(ValidJob(job));
  const GroundFigure off = *find(check.figures, ToolFigure::kOffHelix);
  EXPECT_NEAR(off.largest.value, (max - min) / 2, 1e-4);
  EXPECT_NEAR(off.least.value, -off.largest.value, 1e-12);
}

// Straight flutes on a cylinder: the lower face passes 2.5 mm above the axis, so that the core is a hyperbola.
TEST(GroundJob, TheCoreIsJudgedBetweenTheEnds) {
  GrindJob job = cylinder(0);
  job.cutter.spiral_angle = 0;
  job.process().setup_height = 2.5 * kMillimetre + job.process().wheel_width / 2;
  job.process().depth = 1 * kMillimetre;
  job.process().depth_end = 2 * kMillimetre;
  job.process().infeed = 2 * kMillimetre;
  const double slope = 1.0 / 30, deeper = job.process().wheel_diameter / 2 * (std::sqrt(1 + slope * slope) - 1);
  const auto core = [&](double depth) { return 2 * std::hypot(2.5e-3, 5e-3 - depth - deeper); };
  job.cutter.core_diameter = core(1e-3);
  job.cutter.core_diameter_end = core(2e-3);
  const double off = (core(1e-3) + core(2e-3)) / 2 - core(1.5e-3);
  EXPECT_GT(off, 15e-6);
  for (const double more : {1.02, 0.98}) {
    job.cutter.core_tolerance = more * off;
    const CutterCheck check = checkGroundCutter(ValidJob(job));
    const bool refused = std::any_of(check.reasons.begin(), check.reasons.end(),
                                     [](const Reason& r) { return r.kind == ReasonKind::kCoreSize; });
    EXPECT_EQ(refused, more < 1);
  }
  EXPECT_NEAR(reasonOf(checkGroundCutter(ValidJob(job)), ReasonKind::kCoreSize).x, job.cutter.flute_length / 2, 1e-9);
}

/// A cone of which the wheel still reaches the small end where it is nearly at the apex, 12.0 mm beyond.
GrindJob nearApex(double overtravel_mm) {
  GrindJob job = cylinder(-3.8939);
  job.cutter.end_diameter = 3.15 * kMillimetre;
  job.cutter.cone_angle = 7.461 * kDegree;
  job.cutter.spiral_angle = -2.055 * kDegree;
  job.cutter.rake_angle = 7.839 * kDegree;
  job.cutter.rake_tolerance = 5 * kDegree;
  job.cutter.flute_length = 3.784 * kMillimetre;
  job.process().wheel_diameter = 82.663 * kMillimetre;
  job.process().wheel_width = 1.072 * kMillimetre;
  job.process().depth = job.process().infeed = 0.337 * kMillimetre;
  job.process().finish_infeed = 0;
  job.process().setup_height = 1.29902 * kMillimetre;
  job.process().overtravel_end = overtravel_mm * kMillimetre;
  job.process().overtravel_shank = 1 * kMillimetre;
  return job;
}

/// From which overtravel on, beyond 9.2 mm, a wall of the flute at X = 0 goes farther than before, by trying.
double spoiledByTrying(const GrindJob& job, double core) {
  const brute::Bench bench = brute::benchOf(job, 120, 100);
  double first = 12 * kMillimetre;
  for (int i = 1; i <= 6; ++i) {
    for (const int side : {-1, 1}) {
      const double r = core + (job.cutter.end_diameter / 2 - core) * i / 6;
      const auto end = [&](double s) { return bench.endAt(0, r, s, side).angle; };
      constexpr double kStep = 0.005 * kMillimetre;
      double farthest = -10, overtravel = 9.2 * kMillimetre;
      for (double s = 20 * kMillimetre; s >= -overtravel; s -= kStep) farthest = std::max(farthest, end(s));
      while (overtravel < first && !(end(-overtravel) > farthest)) overtravel += kStep;
      first = overtravel;
    }
  }
  return first;
}

TEST(GroundJob, AnOvertravelThatGrindsIntoTheFluteAgainIsRefused) {
  const double expected =
      spoiledByTrying(nearApex(9.5), groundCutterOf(ValidJob(nearApex(9.5))).section(0).core_radius);
  EXPECT_LT(expected, 10 * kMillimetre);
  for (const double overtravel : {9.2, 9.5, 9.8}) {
    const ValidJob job(nearApex(overtravel));
    const GroundCutter cutter = groundCutterOf(job);
    EXPECT_TRUE(cutter.section(0).teeth[0].complete) << overtravel;
    const CutterCheck check = checkGroundCutter(job, cutter);
    EXPECT_TRUE(check.reasons.empty()) << text(check.reasons);
  }
  for (const double overtravel : {9.95, 11.0, 11.7, 12.0}) {
    GrindJob spoiled = nearApex(overtravel);
    spoiled.process().incomplete_ok = overtravel > 11.5;  // which makes it no better
    const ValidJob job(spoiled);
    const GroundCutter cutter = groundCutterOf(job);
    EXPECT_FALSE(cutter.section(0).teeth[0].complete) << overtravel;
    const CutterCheck check = checkGroundCutter(job, cutter);
    const auto named = std::find_if(check.reasons.begin(), check.reasons.end(),
                                    [](const Reason& r) { return r.kind == ReasonKind::kNotBelow; });
    ASSERT_NE(named, check.reasons.end()) << text(check.reasons);
    EXPECT_EQ(named->field, "process.overtravel_end");
    EXPECT_EQ(named->value, job->process().overtravel_end);
    EXPECT_NEAR(named->limit, expected, 0.02 * kMillimetre);
  }
  // Too short is too short.
  EXPECT_FALSE(groundCutterOf(ValidJob(nearApex(8))).section(0).teeth[0].complete);
}

TEST(GroundJob, TheFlutesRunOutIsThatOfTheWholeToolToItsLastOperation) {
  const GrindJob mill = readJobFile("jobs/end_mill_d10_t4.yaml", "chamfer");
  const GrindProcess& flute = mill.operations.front();
  // No less than half the rim's chord in the depth d that it cuts into the shank, which is sqrt(D d - d^2).
  const double run_out =
      std::sqrt(flute.wheel_diameter * (std::max(flute.depth, flute.depth_end) + shankCut(mill.cutter)));
  const double expected = mill.cutter.flute_length + flute.overtravel_shank + run_out;
  for (const int operation : {0, 1, mill.operation}) {
    EXPECT_NEAR(groundTo(mill.ofOperation(operation)), expected, 1e-12) << operation;
  }
}

}  // namespace test_ground_job
}  // namespace grinder
