// What a plan reports of its setpoints: what is beyond the limits, and the statistics.

#include "curve/reference.h"
#include "plans.h"
#include "stream_checks.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace grinder {
namespace test_plan_reports {

using namespace test_support;

/// The worst position beyond a limit, and how many are beyond it, by moves.
using Beyond = std::map<MoveKind, std::pair<double, std::uint64_t>>;

/// Whether a plan has one reason for each kind of move that is beyond the upper limit of an axis, with its worst and
/// the count, and no other for that limit.
void expectReasons(const JobPlan& plan, const std::vector<Setpoint>& setpoints, int axis, double limit) {
  Beyond expected, found;
  for (const Setpoint& p : setpoints) {
    if (p.position[axis] <= limit) continue;
    auto& [worst, count] = expected[p.move];
    worst = std::max(worst, p.position[axis]);
    ++count;
  }
  for (const Reason& reason : plan.reasons) {
    if (reason.kind != ReasonKind::kPosition || reason.axis != axis || reason.limit != limit) continue;
    EXPECT_TRUE(found.emplace(reason.move, std::make_pair(reason.value, reason.count)).second) << "twice";
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(found, expected) << axisName(axis) << '\n' << textOf(plan);
}

TEST(JobPlan, RefusesEveryAxisBeyondItsLimitsWithTheWorstOfEveryMove) {
  Machine machine = plainMachine();
  machine.limits.max_position << 0.030, 0.04, 0.2, 2;  // the stroke goes to 31 mm
  machine.limits.min_position[kZ] = -1e-5;             // and begins at -12 um
  GrindJob job = paperJob();
  job.tooth_angles = {0, 1, 2};
  job.process().spark_out = 1;
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(ValidJob(job), machine, machine.park, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  // One for each kind of move, of all teeth: stroke, and retract, index, position and return from its end.
  EXPECT_EQ(reasonsWith(plan, "axis X").size(), 5u) << textOf(plan);
  EXPECT_TRUE(contains(textOf(plan),
                       "axis X machine position 31 mm is 1 mm beyond its limit 30 mm (stroke, tooth 1, pass 1, X = "))
      << textOf(plan);
  expectReasons(plan, visited, kX, 0.030);
  expectReasons(plan, visited, kY, 0.04);
  expectReasons(plan, visited, kA, 2);
  std::set<MoveKind> low;
  for (const Setpoint& p : visited) {
    if (p.position[kZ] < -1e-5) low.insert(p.move);
  }
  EXPECT_EQ(low.size(), reasonsWith(plan, "axis Z").size()) << textOf(plan);
  EXPECT_FALSE(low.empty());
  // It goes through to the end.
  EXPECT_TRUE((visited.back().position == machine.park).all());
}

// A control period this long makes the steps of a pair so uneven that they exceed the velocity of A, too.
TEST(JobPlan, HasAReasonForEveryLimitThatAnAxisExceedsInAMove) {
  GrindJob job = steepJob();
  job.cutter.spiral_angle = 10 * units::kDegree;
  job.process().feed = 0.1;
  job.interpolation.tolerance = 1e-3;
  Machine machine = strongMachine();
  machine.period = 0.02;
  machine.limits.max_velocity[kA] = 4.5;
  machine.limits.max_position[kA] = 0.5;
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(ValidJob(job), machine, machine.park, [&](const Setpoint& p) { visited.push_back(p); });
  std::uint64_t fast = 0, far = 0;
  for (const Setpoint& p : visited) {
    if (p.move != MoveKind::kStroke) continue;
    fast += p.velocity[kA] > 4.5 ? 1 : 0;
    far += p.position[kA] > 0.5 ? 1 : 0;
  }
  ASSERT_TRUE(fast > 0 && far > fast);
  std::map<ReasonKind, std::uint64_t> counts;
  for (const Reason& reason : plan.reasons) {
    if (reason.move == MoveKind::kStroke) counts[reason.kind] += reason.count;
  }
  EXPECT_EQ(counts, (std::map<ReasonKind, std::uint64_t>{{ReasonKind::kPosition, far}, {ReasonKind::kVelocity, fast}}));
}

/// An interrupted stroke comes to its end by other points than the plan's.
TEST(JobPlan, LeavesTheToleranceBetweenTheEndOfAStrokeAndTheLimitOfA) {
  for (const double way : {1, -1}) {
    GrindJob job = paperJob();
    job.cutter.spiral_angle *= way;
    Setpoint end;
    end.position << 0.031, 0, 0, ReferenceCurve(job.cutter, job.process().setup_x_shift).a(0.031) + 1;
    const double room = job.interpolation.tolerance / Deviation(job).of(end);
    Machine machine = plainMachine();
    const RunStart run{machine.park, {}, Axes(0, 0, 0, 0.3)};  // A is offset
    const auto planned = [&] { return planJob(ValidJob(job), machine, run); };
    double& limit = (way > 0 ? machine.limits.max_position : machine.limits.min_position)[kA];
    limit = end.position[kA] - 1 + 0.3 + way * 1.01 * room;
    EXPECT_TRUE(planned().good()) << textOf(planned());
    limit -= way * 0.02 * room;
    const JobPlan plan = planned();
    EXPECT_EQ(plan.fault, PlanFault::kLimit);
    ASSERT_EQ(plan.reasons.size(), 1u) << textOf(plan);
    EXPECT_EQ(plan.reasons[0].kind, ReasonKind::kPosition);
    EXPECT_EQ(plan.reasons[0].move, MoveKind::kStroke);
    EXPECT_NEAR(plan.reasons[0].value, limit + way * 0.01 * room, 1e-4 * room);
    EXPECT_EQ(plan.reasons[0].limit, limit);
  }
}

TEST(JobPlan, ReportsWhereTheToleranceIsExceededMost) {
  GrindJob job = steepJob();
  job.process().feed = 0.1;
  job.interpolation.tolerance = 0.2e-6;
  job.tooth_angles = {0, 2};
  job.process().spark_out = 2;
  const Machine machine = strongMachine();
  std::vector<Setpoint> visited;
  const JobPlan plan =
      planJob(ValidJob(job), machine, {machine.park, {1, 2}}, [&](const Setpoint& p) { visited.push_back(p); });
  ASSERT_EQ(plan.reasons.size(), 1u) << textOf(plan);
  const Reason& worst = plan.reasons[0];
  EXPECT_EQ(worst.move, MoveKind::kStroke);
  EXPECT_EQ(worst.tooth, 1);
  EXPECT_EQ(worst.pass, 2);
  ASSERT_LT(worst.cycle, visited.size());
  EXPECT_EQ(worst.x, visited[worst.cycle].position[kX]);
}

/// Every statistic once more, from the setpoints that the visitor saw.
PathStatistics accumulate(const std::vector<Setpoint>& setpoints, const GrindJob& job, double period) {
  const ReferenceCurve curve(job.cutter, job.process().setup_x_shift);
  PathStatistics s;
  s.setpoints = setpoints.size();
  s.max_deviation = maxDeviation(setpoints, job);
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
    if (p.step == StepKind::kEven && p.at_feed) {
      const double feed =
          std::abs(p.position[kX] - setpoints[i - 2].position[kX]) / (2 * period) * edgePerTravel(job.cutter);
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

TEST(JobPlan, ReportsTheStatisticsOfItsSetpoints) {
  GrindJob behind = paperJob();  // the edge is behind the wheel, or ahead of it
  behind.cutter.cone_angle = 9.6 * units::kDegree;
  behind.process().setup_x_shift = -15e-3;
  GrindJob ahead = behind;
  ahead.process().setup_x_shift = 11.847e-3;
  GrindJob many = steepJob();  // teeth and passes
  many.interpolation.even_step = EvenStepRule::kThirdOrder;
  many.interpolation.tolerance = 10e-6;
  many.tooth_angles = {0, 2, 4};
  many.process().infeed = 0.1e-3;
  many.process().spark_out = 1;
  many.process().order = GrindOrder::kPassMajor;
  many.process().direction = StrokeDirection::kToEnd;
  for (const GrindJob& job : {behind, ahead, many}) {
    SCOPED_TRACE(::testing::PrintToString(job));
    expectSame(job, plainMachine());
  }
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
  Work work = *toothedWork(500);
  checkMoveEnds(work);
  work.job.cutter.spiral_angle = 0;  // A never turns: there are moves of no length
  work.job.tooth_angles = {0};
  work.job.process().spark_out = 2;
  checkMoveEnds(work);
  work.job.process().overtravel_end = 0;
  for (const double a : {0.0, 0.5}) {  // perhaps above the begin of the stroke: the first move or two have no length
    work.start << 0, work.machine.park[kY], 0, a;
    checkMoveEnds(work);
  }
}

}  // namespace test_plan_reports
}  // namespace grinder
