// A job whose Z is corrected: where the axes go, and that they keep their limits.

#include "flute_grinder/motion/job_plan.h"

#include "stream_checks.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace grinder {
namespace test_z_law {

using namespace test_support;

double maxCoefficient(const ZCorrection& c) {
  double max = 0;
  for (const double v : c.coefficients) max = std::max(max, std::abs(v));
  return max;
}

GrindJob constantRakeJob() {
  GrindJob job = paperJob();
  job.process().z_law = ZLaw::kConstantRake;
  return job;
}

/// The paper's job with a bow of Z, in coefficients of `height`.
ValidJob bentJob(double height) {
  ZCorrection c;
  c.from = -1e-3;
  c.pieces = 8;
  c.piece = 32e-3 / c.pieces;
  for (int i = 0; i < c.coefficientCount(); ++i) {
    c.coefficients[static_cast<std::size_t>(i)] = height * std::cos(0.7 * i);
  }
  return ValidJob(constantRakeJob()).withZCorrections({c});
}

RC_GTEST_PROP(ZCorrectionProperty, IsTheSplineOfItsCoefficients, ()) {
  const GrindJob job = *test_support::job();
  const ZCorrection c = *zCorrection(job);
  const double x = c.from + c.piece * c.pieces * *uniform(0, 1);
  const double expected = static_cast<double>(referenceCorrection(c, x));
  RC_ASSERT(std::abs(c.at(x).z - expected) <= 1e-14 * maxCoefficient(c));
}

RC_GTEST_PROP(ZCorrectionProperty, ItsDerivativesKeepWithinTheirBounds, ()) {
  const GrindJob job = *test_support::job();
  const ZCorrection c = *zCorrection(job);
  const ZCorrection::Bounds bounds = c.bounds();
  double second = 0;
  for (int i = 0; i <= 200; ++i) {
    const ZCorrection::Value v = c.at(c.from + c.piece * c.pieces * i / 200);
    RC_ASSERT(v.first >= bounds.min_first - 1e-9 * std::abs(bounds.min_first));
    RC_ASSERT(v.first <= bounds.max_first + 1e-9 * std::abs(bounds.max_first));
    RC_ASSERT(std::abs(v.second) <= bounds.second * (1 + 1e-9));
    RC_ASSERT(std::abs(v.third) <= bounds.third * (1 + 1e-9));
    second = std::max(second, std::abs(v.second));
  }
  // Not so wide that they would slow every stroke.
  if (c.pieces > 1) RC_ASSERT(second > bounds.second / 50);
}

// Limits are divided by them: of a correction of nothing they allow any feed.
TEST(ZLaw, ACorrectionOfNothingLimitsNothing) {
  ZCorrection c;
  c.piece = 0.01, c.pieces = 4;
  const ZCorrection::Bounds bounds = c.bounds();
  EXPECT_EQ(1 / bounds.second, std::numeric_limits<double>::infinity());
  EXPECT_EQ(1 / bounds.third, std::numeric_limits<double>::infinity());
}

TEST(ZLaw, WithoutACorrectionThePublishedLawKeepsItsBits) {
  const auto expected = all({paperJob(), plainMachine(), plainMachine().park});
  const auto setpoints = all({constantRakeJob(), plainMachine(), plainMachine().park});
  ASSERT_EQ(setpoints.size(), expected.size());
  for (std::size_t i = 0; i < setpoints.size(); ++i) {
    EXPECT_TRUE((setpoints[i].position == expected[i].position).all()) << i;
  }
}

TEST(ZLaw, AJobWithoutItsCorrectionsIsRefused) {
  const ValidJob job(constantRakeJob());
  EXPECT_THROW(GrindProgram(job, plainMachine(), plainMachine().park), std::invalid_argument);
  const JobPlan plan = planJob(job, plainMachine(), plainMachine().park);
  EXPECT_EQ(plan.fault, PlanFault::kInvalidJob);
  ASSERT_EQ(plan.reasons.size(), 1u);
  EXPECT_NE(plan.reasons[0].detail.find("withLaws()"), std::string::npos);
  EXPECT_EQ(ValidJob(paperJob()).zCorrectionOf(0).pieces, 0);
  EXPECT_THROW(job.withZCorrections(std::vector<ZCorrection>(2)), std::invalid_argument);
}

TEST(ZLaw, ASlightBowCostsNoFeed) {
  const GrindProgram program(bentJob(30e-6), plainMachine(), plainMachine().park);
  EXPECT_TRUE(program.schedule().feedLimits().empty());
  const GrindProgram straight(ValidJob(paperJob()), plainMachine(), plainMachine().park);
  EXPECT_EQ(program.schedule().feedSpeed(), straight.schedule().feedSpeed());
}

TEST(ZLaw, AStrongBowTakesFeedAndNamesTheAxis) {
  Machine slow = plainMachine(), smooth = plainMachine();
  slow.limits.max_acceleration[kZ] = 5e-4;
  smooth.limits.max_jerk[kZ] = 2e-3;
  const std::pair<const char*, Machine> cases[]{{"axis Z acceleration", slow}, {"axis Z jerk", smooth}};
  for (const auto& [cause, machine] : cases) {
    SCOPED_TRACE(cause);
    const JobPlan plan = planJob(bentJob(500e-6), machine, machine.park);
    EXPECT_TRUE(plan.good()) << text(plan.reasons);
    ASSERT_EQ(plan.statistics.feed_limits.size(), 1u);
    EXPECT_EQ(plan.statistics.feed_limits[0].cause, cause);
    EXPECT_LT(plan.statistics.max_feed, 0.0099);
    // The bow may take a quarter of each.
    const ZCorrection::Bounds bow = plan.program->helix(0).z_correction.bounds();
    const double v = plan.program->schedule().feedSpeed();
    EXPECT_NEAR(cause == std::string("axis Z jerk") ? bow.third * v * v * v / 2e-3 : bow.second * v * v / 5e-4, 0.25,
                1e-9);
    EXPECT_LT(plan.statistics.max_acceleration[kZ], 1.001 * machine.limits.max_acceleration[kZ]);
    EXPECT_LT(plan.statistics.max_jerk[kZ], 1.001 * machine.limits.max_jerk[kZ]);
  }
}

/// An interrupted stroke has its setpoints elsewhere on the bow.
TEST(ZLaw, ABowKeepsOffTheLimitByWhatItCanRiseBetweenTwoSetpoints) {
  const ValidJob job = bentJob(500e-6);
  for (const int way : {1, -1}) {
    Machine machine = plainMachine();
    double farthest = 0;
    planJob(job, machine, machine.park, [&](const Setpoint& p) {
      if (p.move == MoveKind::kStroke) farthest = std::max(farthest, way * p.position[kZ]);
    });
    const double room = machine.limits.max_acceleration[kZ] * machine.period * machine.period / 8;
    double& limit = (way > 0 ? machine.limits.max_position : machine.limits.min_position)[kZ];
    limit = way * (farthest + 1.01 * room);
    EXPECT_TRUE(planJob(job, machine, machine.park).good());
    limit = way * (farthest + 0.99 * room);
    const JobPlan plan = planJob(job, machine, machine.park);
    ASSERT_EQ(plan.reasons.size(), 1u) << text(plan.reasons);
    EXPECT_EQ(plan.reasons[0].kind, ReasonKind::kPosition);
    EXPECT_NEAR(plan.reasons[0].value, limit + way * 0.01 * room, 1e-4 * room);
    EXPECT_EQ(plan.reasons[0].limit, limit);
  }
}

}  // namespace test_z_law
}  // namespace grinder
