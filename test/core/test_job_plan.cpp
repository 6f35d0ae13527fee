#include "flute_grinder/core/job_plan.h"

#include "generators.h"
#include "reference.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace flute_grinder {
namespace {

using testing::paperJob;
using testing::plainMachine;
using testing::Real;
using testing::ReferenceCurve;
using testing::Work;

JobPlan planOf(const GrindJob& job, const Machine& machine = plainMachine()) {
  return planJob(job, machine, machine.park);
}

std::string textOf(const JobPlan& plan) {
  std::string text;
  for (const std::string& reason : plan.reasons) text += reason + "\n";
  return text;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A cutter on which `published` drifts off: D1 2 mm, C 15 deg, S 45 deg.
GrindJob steepJob() {
  GrindJob j = paperJob();
  j.cutter = {2e-3, 15 * units::kDegree, 45 * units::kDegree, 0, 20e-3};
  j.process.overtravel_end = 0;
  j.process.depth = j.process.infeed = 0.2e-3;
  return j;
}

/// Every statistic once more, from the setpoints that the visitor saw.
PlanStatistics accumulate(const std::vector<Setpoint>& setpoints, const GrindJob& job, double period) {
  const ReferenceCurve curve(job.cutter);
  const CutterGeometry& g = job.cutter;
  const Real normal = std::cos(std::atan(std::tan(Real(g.spiral_angle)) * std::cos(Real(g.cone_angle))));
  PlanStatistics s;
  s.setpoints = setpoints.size();
  s.duration = static_cast<double>(setpoints.size() - 1) * period;
  const auto end = [&](std::size_t i, std::size_t back) {
    return i >= 2 * back ? setpoints[i - 2 * back].position : setpoints[0].position;
  };
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    s.move_duration[static_cast<std::size_t>(p.move)] += period;
    const Axes velocity = (p.position - setpoints[i - 1].position) / period;
    const Axes before =
        i < 2 ? Axes(Axes::Zero()) : Axes((setpoints[i - 1].position - setpoints[i - 2].position) / period);
    s.max_velocity = s.max_velocity.max(velocity.abs());
    s.ripple_acceleration = s.ripple_acceleration.max((velocity - before).abs() / period);
    if (i % 2 == 0) {
      const double pair = 2 * period;
      s.max_acceleration = s.max_acceleration.max((end(i, 0) - 2 * end(i, 1) + end(i, 2)).abs() / (pair * pair));
      s.max_jerk = s.max_jerk.max((end(i, 0) - 3 * end(i, 1) + 3 * end(i, 2) - end(i, 3)).abs() / (pair * pair * pair));
    }
    if (p.step == StepKind::kNone) continue;
    const Real x = p.position[kX];
    const auto error = static_cast<double>(std::abs(curve.a(x) - (Real(p.position[kA]) - job.tooth_angles[p.tooth])));
    (p.step == StepKind::kOdd ? s.max_odd_error : s.max_even_error) =
        std::max(p.step == StepKind::kOdd ? s.max_odd_error : s.max_even_error, error);
    const Real radius = Real(g.end_diameter) / 2 + x * std::tan(Real(g.cone_angle));
    s.max_deviation = std::max(s.max_deviation, static_cast<double>(error * radius * normal));
    if (p.step == StepKind::kEven && p.at_feed) {
      const double feed =
          std::abs(p.position[kX] - setpoints[i - 2].position[kX]) / (2 * period) * testing::edgePerTravel(g);
      s.min_feed = s.min_feed == 0 ? feed : std::min(s.min_feed, feed);
      s.max_feed = std::max(s.max_feed, feed);
    }
  }
  return s;
}

void expectNear(const Axes& value, const Axes& expected, double noise) {
  for (int axis = 0; axis < kAxisCount; ++axis)
    EXPECT_NEAR(value[axis], expected[axis], 1e-9 * expected[axis] + noise) << axis;
}

void expectSame(const GrindJob& job, const Machine& machine) {
  std::vector<Setpoint> setpoints;
  const JobPlan plan = planJob(job, machine, machine.park, {}, [&](const Setpoint& p) { setpoints.push_back(p); });
  ASSERT_TRUE(plan.good()) << textOf(plan);
  const PlanStatistics& s = plan.statistics;
  const PlanStatistics expected = accumulate(setpoints, job, machine.period);
  EXPECT_EQ(s.setpoints, expected.setpoints);
  EXPECT_NEAR(s.duration, expected.duration, 1e-9);
  for (std::size_t i = 0; i < kMoveKindCount; ++i)
    EXPECT_NEAR(s.move_duration[i], expected.move_duration[i], 1e-9) << i;
  EXPECT_NEAR(s.max_odd_error, expected.max_odd_error, 1e-14);
  EXPECT_NEAR(s.max_even_error, expected.max_even_error, 1e-14);
  EXPECT_NEAR(s.max_deviation, expected.max_deviation, 1e-16);
  EXPECT_NEAR(s.min_feed, expected.min_feed, 1e-9 * expected.min_feed);
  EXPECT_NEAR(s.max_feed, expected.max_feed, 1e-9 * expected.max_feed);
  expectNear(s.max_velocity, expected.max_velocity, 1e-11);
  expectNear(s.max_acceleration, expected.max_acceleration, 1e-8);
  expectNear(s.max_jerk, expected.max_jerk, 1e-4);
  expectNear(s.ripple_acceleration, expected.ripple_acceleration, 1e-8);
}

TEST(JobPlan, TellsTheStatisticsOfThePapersJob) { expectSame(paperJob(), plainMachine()); }

TEST(JobPlan, TellsTheStatisticsOfManyTeethAndPasses) {
  GrindJob job = steepJob();
  job.interpolation.even_step = EvenStepRule::kThirdOrder;
  job.interpolation.tolerance = 10e-6;
  job.tooth_angles = {0, 2, 4};
  job.process.infeed = 0.1e-3;
  job.process.spark_out = 1;
  job.process.order = GrindOrder::kPassMajor;
  job.process.direction = StrokeDirection::kToEnd;
  expectSame(job, plainMachine());
}

TEST(JobPlan, MovesTakeTheWholeTime) {
  const JobPlan plan = planOf(paperJob());
  double sum = 0;
  for (const double duration : plan.statistics.move_duration) sum += duration;
  EXPECT_NEAR(sum, plan.statistics.duration, 1e-9);
}

TEST(JobPlan, OfThePapersJobIsGoodAndHasNoReasons) {
  const JobPlan plan = planOf(paperJob());
  EXPECT_TRUE(plan.good());
  EXPECT_EQ(plan.fault, PlanFault::kNone);
  EXPECT_TRUE(plan.reasons.empty());
  ASSERT_NE(plan.program, nullptr);
  EXPECT_EQ(plan.statistics.feed_limited_by, "");
  EXPECT_NEAR(plan.statistics.min_feed, 0.01, 1e-8);
  EXPECT_NEAR(plan.statistics.max_feed, 0.01, 1e-8);
}

TEST(JobPlan, ReportsTheRippleOfTheOddEvenSteps) {
  // A turns by 2 kappa dl once per pair: |k b| v^2 / u^2 on the mean, twice that by single cycles, at X = -1 mm.
  const JobPlan plan = planOf(paperJob());
  const ReferenceCurve curve(paperJob().cutter);
  const Real speed = 0.01 / testing::edgePerTravel(paperJob().cutter);
  const Real thin = 2 * curve.k * curve.b * speed * speed;
  EXPECT_GE(plan.statistics.ripple_acceleration[kA], static_cast<double>(thin / (curve.u(0.001L) * curve.u(0.001L))));
}

TEST(JobPlan, VisitsWhatTheStreamGives) {
  std::vector<Setpoint> visited;
  const Machine machine = plainMachine();
  const JobPlan plan = planJob(paperJob(), machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
  SetpointStream stream(*plan.program);
  Setpoint p;
  std::size_t i = 0;
  for (; stream.next(p); ++i) {
    ASSERT_LT(i, visited.size());
    ASSERT_TRUE((visited[i].position == p.position).all());
    ASSERT_EQ(visited[i].cycle, p.cycle);
  }
  EXPECT_EQ(i, visited.size());
}

TEST(JobPlan, RefusesAnInvalidJobWithAllReasons) {
  GrindJob job = paperJob();
  job.cutter.end_diameter = -1;
  job.process.feed = std::numeric_limits<double>::quiet_NaN();
  const JobPlan plan = planOf(job);
  EXPECT_FALSE(plan.good());
  EXPECT_EQ(plan.fault, PlanFault::kInvalidJob);
  EXPECT_EQ(plan.program, nullptr);
  ASSERT_EQ(plan.reasons.size(), 2u);
  EXPECT_TRUE(contains(plan.reasons[0], "cutter.end_diameter = -1 m; allowed: "));
  EXPECT_TRUE(contains(plan.reasons[1], "process.feed = nan m/s; allowed: "));
}

TEST(JobPlan, TellsInTheUnitsAskedFor) {
  GrindJob job = paperJob();
  job.cutter.end_diameter = -1e-3;
  const Machine machine = plainMachine();
  const JobPlan plan = planJob(job, machine, machine.park, {}, {}, UnitSystem::kShop);
  EXPECT_TRUE(contains(textOf(plan), "cutter.end_diameter_mm = -1 mm")) << textOf(plan);
}

TEST(JobPlan, RefusesAFirstPassThatIsNotThere) {
  const Machine machine = plainMachine();
  const JobPlan plan = planJob(paperJob(), machine, machine.park, {1, 0});
  EXPECT_EQ(plan.fault, PlanFault::kInvalidJob);
  EXPECT_TRUE(contains(textOf(plan), "first_tooth = 1"));
}

TEST(JobPlan, RefusesABadMachine) {
  Machine machine = plainMachine();
  machine.period = 0;
  EXPECT_EQ(planOf(paperJob(), machine).fault, PlanFault::kInvalidJob);
}

TEST(JobPlan, RefusesAWayBeyondAnAxisLimitWithTheAmount) {
  Machine machine = plainMachine();
  machine.limits.max_position[kX] = 0.030;  // the stroke goes to 31 mm
  bool beyond = false;
  const JobPlan plan =
      planJob(paperJob(), machine, machine.park, {}, [&](const Setpoint& p) { beyond = p.position[kX] > 0.030; });
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  ASSERT_EQ(plan.reasons.size(), 1u);
  EXPECT_TRUE(contains(plan.reasons[0], "axis_x position 0.03")) << plan.reasons[0];
  EXPECT_TRUE(contains(plan.reasons[0], "beyond its limit 0.03 m")) << plan.reasons[0];
  EXPECT_TRUE(contains(plan.reasons[0], "stroke")) << plan.reasons[0];
  EXPECT_TRUE(beyond);  // the last setpoint visited is the one refused
}

TEST(JobPlan, RefusesATurnBeyondTheLimitOfA) {
  Machine machine = plainMachine();
  machine.limits.max_position[kA] = 2;
  const JobPlan plan = planOf(paperJob(), machine);
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  EXPECT_TRUE(contains(textOf(plan), "axis_a position 2.0")) << textOf(plan);
  EXPECT_TRUE(contains(textOf(plan), "beyond its limit 2 rad")) << textOf(plan);
}

TEST(JobPlan, RefusesAStartBeyondALimit) {
  const Machine machine = plainMachine();
  Axes start = machine.park;
  start[kX] = -0.5;
  const JobPlan plan = planJob(paperJob(), machine, start);
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  EXPECT_TRUE(contains(textOf(plan), "axis_x position -0.5 m")) << textOf(plan);
  EXPECT_TRUE(contains(textOf(plan), "limit -0.3 m")) << textOf(plan);
}

TEST(JobPlan, RefusesAToleranceThatNoFeedMeets) {
  GrindJob job = paperJob();
  job.interpolation.tolerance = 1e-15;
  const JobPlan plan = planOf(job);
  EXPECT_FALSE(plan.good());
  EXPECT_TRUE(contains(textOf(plan), "tolerance")) << textOf(plan);
}

/// Limits that leave the feed to the tolerance.
Machine strongMachine() {
  Machine m = plainMachine();
  m.limits.max_velocity *= 50;
  m.limits.max_acceleration *= 1000;
  m.limits.max_jerk *= 100000;
  return m;
}

TEST(JobPlan, RefusesPublishedWhereItDriftsOffTheTolerance) {
  // The even points of `published` drift by half of the odd points' error, in rad; six times the radius makes it too
  // much.
  GrindJob job = steepJob();
  job.process.feed = 0.1;
  job.interpolation.tolerance = 0.2e-6;
  const JobPlan published = planOf(job, strongMachine());
  EXPECT_EQ(published.fault, PlanFault::kTolerance) << textOf(published);
  EXPECT_EQ(published.reasons.size(), 1u);
  EXPECT_TRUE(contains(textOf(published), "interpolation.tolerance = 2e-07 m")) << textOf(published);
  EXPECT_EQ(published.statistics.feed_limited_by, "interpolation tolerance");
  EXPECT_GT(published.statistics.max_deviation, 0.2e-6);
}

TEST(JobPlan, TakesTheOtherRulesWherePublishedDriftsOff) {
  GrindJob job = steepJob();
  job.process.feed = 0.1;
  job.interpolation.tolerance = 0.2e-6;
  for (const EvenStepRule rule : {EvenStepRule::kThirdOrder, EvenStepRule::kExact}) {
    job.interpolation.even_step = rule;
    const JobPlan plan = planOf(job, strongMachine());
    EXPECT_TRUE(plan.good()) << toString(rule) << ": " << textOf(plan);
    EXPECT_EQ(plan.statistics.feed_limited_by, "interpolation tolerance");
    EXPECT_LE(plan.statistics.max_deviation, 0.2e-6);
    EXPECT_GT(plan.statistics.max_deviation, 0.18e-6);
  }
}

TEST(JobPlan, CutsTheFeedForTheTolerance) {
  GrindJob job = steepJob();
  job.process.feed = 0.1;
  job.interpolation.tolerance = 0.1e-6;
  job.interpolation.even_step = EvenStepRule::kExact;
  const JobPlan plan = planOf(job);
  ASSERT_TRUE(plan.good()) << textOf(plan);
  EXPECT_LE(plan.statistics.max_deviation, 0.1e-6);
  EXPECT_LT(plan.statistics.max_feed, 0.1);
}

TEST(JobPlan, NamesTheAxisThatHindersTheFeedAtASmallEnd) {
  GrindJob job = steepJob();
  job.cutter.end_diameter = 0.5e-3;
  job.process.depth = job.process.infeed = 0.05e-3;
  job.process.feed = 0.05;
  job.interpolation.tolerance = 100e-6;
  const JobPlan plan = planOf(job);
  ASSERT_TRUE(plan.good()) << textOf(plan);
  EXPECT_EQ(plan.statistics.feed_limited_by.find("axis_a"), 0u) << plan.statistics.feed_limited_by;
}

TEST(JobPlan, RefusesAFeedBelowTheSlowest) {
  Machine machine = plainMachine();
  machine.limits.max_velocity[kA] = 1e-5;
  const JobPlan plan = planOf(paperJob(), machine);
  EXPECT_EQ(plan.fault, PlanFault::kInvalidJob);
  EXPECT_TRUE(contains(textOf(plan), "axis_a velocity")) << textOf(plan);
}

/// Whatever the job, the feed is chosen such that no axis is asked for more than it may do.
RC_GTEST_PROP(JobPlanProperty, NeverRefusesAJobForAxisDynamics, ()) {
  const Work work = *testing::work(2000);
  const JobPlan plan = planJob(work.job, work.machine, work.start);
  if (plan.fault != PlanFault::kTolerance) {
    RC_ASSERT(textOf(plan) == "");
    RC_ASSERT(plan.good());
  }
  RC_ASSERT((plan.statistics.max_velocity <= work.machine.limits.max_velocity * (1 + 1e-6)).all());
}

RC_GTEST_PROP(JobPlanProperty, ExactIsNeverRefusedForTheTolerance, ()) {
  Work work = *testing::work(2000);
  work.job.interpolation.even_step = EvenStepRule::kExact;
  const JobPlan plan = planJob(work.job, work.machine, work.start);
  RC_ASSERT(plan.fault != PlanFault::kTolerance);
  RC_ASSERT(plan.statistics.max_deviation <= work.job.interpolation.tolerance);
}

}  // namespace
}  // namespace flute_grinder
