#include "plans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

/// @file
/// A plan generates only what its moves have not in common. It is held against one of every setpoint, which a visitor
/// makes planJob() generate.
namespace grinder {
namespace test_plan_shapes {

using namespace test_support;

JobPlan planOfAllSetpoints(const Work& work, const ToothPass& first = {}) {
  return planJob(work.valid(), work.machine, {work.start, first}, [](const Setpoint&) {});
}

/// Some teeth in some passes, in a stroke of some hundred cycles.
rc::Gen<Work> wholeTool() {
  return rc::gen::exec([] {
    Work w = *work(600);
    GrindJob& j = w.job;
    const int teeth = *whole(1, 6);
    j.tooth_angles.clear();
    for (int i = 0; i < teeth; ++i)
      j.tooth_angles.push_back(2 * units::kPi / teeth * (i + (i > 0 ? *uniform(0, 0.5) : 0)));
    if (*whole(0, 3) == 0) {
      for (int i = 0; i < teeth; ++i) j.spiral_angles.push_back(j.cutter.spiral_angle * (i % 2 == 0 ? 1 : 0.9));
    }
    j.process().order = *rc::gen::element(GrindOrder::kToothMajor, GrindOrder::kPassMajor);
    j.process().infeed = j.process().depth / *uniform(1, 4);
    j.process().finish_infeed = *whole(0, 1) * j.process().depth * 0.1;
    j.process().wheel_wear_per_pass = *whole(0, 1) * 1e-6;
    if (*whole(0, 3) == 0) j.process().depth_end = j.process().depth * *uniform(0.6, 1.2);
    RC_PRE(validate(j).empty());
    if (*whole(0, 3) == 0) {
      j.process().z_law = ZLaw::kConstantRake;
      w.z_correction = *zCorrection(j);
    }
    return w;
  });
}

/// The largest of the positions of a work's moves, by axis.
Axes maxPosition(const JobPlan& plan) {
  Axes max = plan.program->start().abs();
  for (const Move& move : plan.program->moves()) max = max.max(move.to.abs());
  return max;
}

/// Equal but for the rounding of differences between `max` positions, over a time to the power of `order`.
void requireNear(const Axes& a, const Axes& b, const Axes& max, double time, int order) {
  const double epsilon = std::numeric_limits<double>::epsilon();
  const Axes rounding = 8 * epsilon * max * std::pow(2 / time, order) + 1e-12 * b;
  RC_ASSERT(((a - b).abs() <= rounding).all());
}

void requireSame(const JobPlan& plan, const JobPlan& all) {
  RC_ASSERT(plan.fault == all.fault);
  RC_ASSERT(textOf(plan) == textOf(all));
  RC_ASSERT(plan.move_ends == all.move_ends);
  const PathStatistics &s = plan.statistics, &t = all.statistics;
  RC_ASSERT(s.setpoints == t.setpoints);
  RC_ASSERT(s.duration == t.duration);
  RC_ASSERT(s.move_duration == t.move_duration);
  RC_ASSERT(s.max_odd_error == t.max_odd_error);
  RC_ASSERT(s.max_even_error == t.max_even_error);
  RC_ASSERT(s.max_deviation == t.max_deviation);
  RC_ASSERT(s.min_feed == t.min_feed);
  RC_ASSERT(s.max_feed == t.max_feed);
  RC_ASSERT(causesOf(plan.statistics.feed_limits) == causesOf(all.statistics.feed_limits));
  if (!plan.program) return;
  const Axes max = maxPosition(all);
  const double period = plan.program->machine().period;
  requireNear(s.max_velocity, t.max_velocity, max, period, 1);
  requireNear(s.ripple_acceleration, t.ripple_acceleration, max, period, 2);
  requireNear(s.max_acceleration, t.max_acceleration, max, 2 * period, 2);
  requireNear(s.max_jerk, t.max_jerk, max, 2 * period, 3);
}

/// One limit is moved to somewhere about what the job asks for: a little less, a little more, or just that.
RC_GTEST_PROP(PlanShapes, AreRefusedAsAllSetpointsAre, ()) {
  Work work = *wholeTool();
  const JobPlan free = planOfAllSetpoints(work);
  RC_PRE(free.good());
  const int axis = *whole(0, kAxisCount - 1);
  const double factor = *rc::gen::element(0.7, 0.999, 1.0, 1.001);
  Axes lowest = work.start, highest = work.start;
  planJob(work.valid(), work.machine, work.start, [&](const Setpoint& p) {
    lowest = lowest.min(p.position);
    highest = highest.max(p.position);
  });
  switch (*whole(0, 3)) {
    case 0: work.machine.limits.max_position[axis] = lowest[axis] + (highest[axis] - lowest[axis]) * factor; break;
    case 1: work.machine.limits.min_position[axis] = highest[axis] - (highest[axis] - lowest[axis]) * factor; break;
    case 2: work.job.interpolation.tolerance = std::max(1e-9, free.statistics.max_deviation * factor); break;
    case 3: work.machine.max_job_duration = free.statistics.duration * factor; break;
  }
  RC_PRE((work.machine.limits.min_position < work.machine.limits.max_position).all());
  const JobPlan all = planOfAllSetpoints(work);
  RC_CLASSIFY(all.good());
  requireSame(planJob(work.valid(), work.machine, work.start), all);
}

RC_GTEST_PROP(PlanShapes, GiveWhatAllSetpointsGiveFromAnyPassOn, ()) {
  const Work work = *wholeTool();
  const std::vector<JobPass> passes = work.valid().passes();
  const int begin = *whole(0, 1) * *whole(0, static_cast<int>(passes.size()) - 1);
  const ToothPass first = passes[static_cast<std::size_t>(begin)].place;
  const JobPlan all = planOfAllSetpoints(work, first);
  RC_CLASSIFY(all.good());
  requireSame(planJob(work.valid(), work.machine, {work.start, first}), all);
}

// The paper's tool as a whole, with strokes of thousands of setpoints and infeeds at constant speed. A hundred
// strokes are generated in little more than the time of one.
TEST(PlanShapes, OfAWholeToolGiveWhatAllSetpointsGive) {
  for (const EvenStepRule rule : {EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact}) {
    Work work{paperJob(), plainMachine(), plainMachine().park};
    work.job.interpolation.even_step = rule;
    work.job.tooth_angles = {0, 1.1, 2.5, 4};
    const double spiral = work.job.cutter.spiral_angle;
    work.job.spiral_angles = {spiral, 0.9 * spiral, spiral, 0.9 * spiral};
    work.job.process().infeed = work.job.process().depth / 5;
    work.job.process().spark_out = 20;
    const JobPlan all = planOfAllSetpoints(work);
    ASSERT_TRUE(all.good()) << textOf(all);
    requireSame(planJob(work.valid(), work.machine, work.start), all);
    int looks = 0, looks_at_all = 0;
    planJob(work.valid(), work.machine, work.start, {}, [&](double) { return ++looks > 0; });
    planJob(
        work.valid(), work.machine, work.start, [](const Setpoint&) {}, [&](double) { return ++looks_at_all > 0; });
    EXPECT_LE(looks * 10, looks_at_all) << "a planner asks its watch after every so many setpoints";
  }
}

// What moves may have in common but for what tells them apart: an infeed is slower than an approach of the same way.
// The first index has the way of the next.
TEST(PlanShapes, TellMovesOfTheSameWayApart) {
  Work work{paperJob(), plainMachine(), plainMachine().park};
  work.job.cutter.cone_angle = work.job.cutter.spiral_angle = 0;
  work.job.tooth_angles = {0, 0.5, 1};
  work.job.process().clearance = 1.0 / 256;
  work.job.process().depth = work.job.process().infeed = 1.0 / 2048;
  work.start << 0, 2.0 / 256 + 1.0 / 2048, 0, -0.5;
  work.machine.park = work.start;
  const GrindProgram program = work.program();
  const std::vector<Move>& moves = program.moves();
  ASSERT_TRUE((moves[3].to - moves[2].to == moves[2].to - moves[1].to).all() && moves[3].kind == MoveKind::kInfeed);
  const JobPlan all = planOfAllSetpoints(work);
  ASSERT_TRUE(all.good()) << textOf(all);
  requireSame(planJob(work.valid(), work.machine, work.start), all);
}

// Of a rapid of 100 m at 0.2 m/s next to nothing is generated.
TEST(PlanShapes, LeaveOutAConstantSpeed) {
  Work work{paperJob(), plainMachine(), plainMachine().park};
  work.start[kX] = work.machine.limits.min_position[kX] = -100;
  int looks = 0;
  const JobPlan plan = planJob(work.valid(), work.machine, work.start, {}, [&](double) { return ++looks > 0; });
  EXPECT_TRUE(plan.good()) << textOf(plan);
  EXPECT_GT(plan.statistics.setpoints, 500000u);
  EXPECT_LE(looks, 5) << "a planner asks its watch after every 4096 setpoints";
}

// A plan that is not of all setpoints is watched too, in a stroke and in a rapid of months.
TEST(PlanShapes, AreGivenUp) {
  for (const double from : {-1.0, -1e9}) {
    Work work{paperJob(), plainMachine(), plainMachine().park};
    work.job.process().feed /= 3;
    work.start[kX] = work.machine.limits.min_position[kX] = from;
    work.machine.max_job_duration = 1e9;
    int looks = 0;
    const JobPlan plan = planJob(work.valid(), work.machine, work.start, {}, [&](double) { return ++looks < 2; });
    EXPECT_EQ(plan.fault, PlanFault::kGivenUp);
    EXPECT_EQ(looks, 2);
    EXPECT_EQ(textOf(plan), "given up while it was planned\n");
  }
}

}  // namespace test_plan_shapes
}  // namespace grinder
