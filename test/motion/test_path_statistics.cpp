#include "curve/reference.h"
#include "plans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grinder {
namespace test_path_statistics {

using namespace test_support;

/// Every statistic once more, from the setpoints that the visitor saw.
PathStatistics accumulate(const std::vector<Setpoint>& setpoints, const GrindJob& job, double period) {
  const ReferenceCurve curve(job.cutter, job.process.setup_lead);
  const CutterGeometry& g = job.cutter;
  const Real normal = std::cos(std::atan(std::tan(Real(g.spiral_angle)) * std::cos(Real(g.cone_angle))));
  PathStatistics s;
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
    const Real radius = Real(g.end_diameter) / 2 + (x - curve.lead) * std::tan(Real(g.cone_angle));
    s.max_deviation = std::max(s.max_deviation, static_cast<double>(error * radius * normal));
    if (p.step == StepKind::kEven && p.at_feed) {
      const double feed =
          std::abs(p.position[kX] - setpoints[i - 2].position[kX]) / (2 * period) * test_support::edgePerTravel(g);
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
  const JobPlan plan =
      planJob(ValidJob(job), machine, machine.park, [&](const Setpoint& p) { setpoints.push_back(p); });
  ASSERT_TRUE(plan.good()) << textOf(plan);
  const PathStatistics& s = plan.statistics;
  const PathStatistics expected = accumulate(setpoints, job, machine.period);
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

TEST(JobPlan, ReportsTheStatisticsOfThePapersJob) { expectSame(paperJob(), plainMachine()); }

TEST(JobPlan, ReportsTheStatisticsWhereTheEdgeIsAheadOfTheWheelOrBehind) {
  GrindJob job = paperJob();
  job.cutter.cone_angle = 9.6 * units::kDegree;
  for (const double lead : {-15e-3, 11.847e-3}) {
    SCOPED_TRACE(lead);
    job.process.setup_lead = lead;
    expectSame(job, plainMachine());
  }
}

TEST(JobPlan, ReportsTheStatisticsOfManyTeethAndPasses) {
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

/// Whether move_ends are the setpoints' own.
void checkMoveEnds(const Work& work) {
  std::vector<Setpoint> visited;
  const JobPlan plan =
      planJob(work.valid(), work.machine, work.start, [&](const Setpoint& p) { visited.push_back(p); });
  std::vector<std::uint64_t> expected;
  std::size_t i = 0;
  for (const Move& move : plan.program->moves()) {
    // The next setpoints of that kind, tooth and pass are the move's; there are none if it has no length.
    while (i + 1 < visited.size() && visited[i + 1].move == move.kind && visited[i + 1].tooth == move.tooth &&
           visited[i + 1].pass == move.pass) {
      ++i;
    }
    expected.push_back(visited[i].cycle);
  }
  RC_ASSERT(plan.move_ends == expected);
  RC_ASSERT(plan.move_ends.back() + 1 == plan.statistics.setpoints);
}

RC_GTEST_PROP(JobPlanProperty, ReportsWhereEveryMoveEnds, ()) {
  Work work = *test_support::toothedWork(500);
  checkMoveEnds(work);
  work.job.cutter.spiral_angle = 0;  // A never turns: there are moves of no length
  work.job.tooth_angles = {0};
  work.job.process.spark_out = 2;
  checkMoveEnds(work);
}

}  // namespace test_path_statistics
}  // namespace grinder
