#include "flute_grinder/job/job_file.h"
#include "plans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grinder {
namespace test_job_plan {

using namespace test_support;

TEST(JobPlan, RefusesASwivelThatTheMachineDoesNotHave) {
  Machine machine = plainMachine();
  machine.swivel = {-30 * units::kDegree, 45 * units::kDegree};
  GrindJob job = paperJob();
  for (const double swivel : {machine.swivel.from, 0.0, machine.swivel.to}) {
    job.process().setup_swivel = swivel;
    EXPECT_TRUE(planOf(job, machine).good()) << swivel;
  }
  for (const double swivel : {-30.0001 * units::kDegree, 45.0001 * units::kDegree}) {
    job.process().setup_swivel = swivel;
    const JobPlan plan = planOf(job, machine);
    EXPECT_EQ(plan.fault, PlanFault::kInvalidJob);
    EXPECT_TRUE(contains(textOf(plan), "; allowed: -30 to 45 deg, to which the machine swivels")) << textOf(plan);
  }
}

TEST(JobPlan, RefusesAJobThatTakesTooLongBeforeItIsMade) {
  // 64 teeth in 300 passes of 5 mm + 32 mm sqrt(1 + tan^2 5 + tan^2 30) at 0.1 mm/min: 42 mm each, 25,200 s.
  GrindJob job = paperJob();
  job.tooth_angles.clear();
  for (int i = 0; i < 64; ++i) job.tooth_angles.push_back(i * 0.09);
  job.process().infeed = job.process().depth / 300;
  job.process().feed = 0.1e-3 / 60;
  const Machine machine = plainMachine();
  int looks = 0;
  const JobPlan plan = planJob(ValidJob(job), machine, machine.park, {}, [&](double) { return ++looks > 0; });
  EXPECT_EQ(plan.fault, PlanFault::kTooLong);
  EXPECT_EQ(plan.program, nullptr);
  EXPECT_EQ(looks, 0);
  ASSERT_EQ(plan.reasons.size(), 1u);
  const double pass = (5 + 32 * test_support::edgePerTravel(job.cutter)) / 0.1 * 60;
  EXPECT_EQ(plan.reasons[0].kind, ReasonKind::kTooLong);
  EXPECT_NEAR(plan.reasons[0].value, 64 * 300 * pass, 1e-6 * pass);
  EXPECT_EQ(plan.reasons[0].limit, 86400);
  EXPECT_EQ(plan.reasons[0].unit, Unit::kSecond);
  EXPECT_EQ(plan.reasons[0].count, 19200u);
  // Of a job that goes on at tooth 10, pass 5, what is left.
  for (const GrindOrder order : {GrindOrder::kToothMajor, GrindOrder::kPassMajor}) {
    job.process().order = order;
    const JobPlan rest = planJob(ValidJob(job), machine, {machine.park, {10, 5}});
    ASSERT_EQ(rest.reasons.size(), 1u);
    const double before = order == GrindOrder::kToothMajor ? 10 * 300 + 5 : 5 * 64 + 10;
    EXPECT_NEAR(rest.reasons[0].value, (64 * 300 - before) * pass, 1e-6 * pass);
  }
}

/// The gashes of short teeth are shorter than the first.
TEST(JobPlan, RefusesNoGashesThatTakeLessThanAllowed) {
  GrindJob job = readJobFile("jobs/center_cutting_d10_t4.yaml", "gash");
  job.process().feed = 1e-5;
  const ValidJob gash(job), flutes(job.ofOperation(0));
  const ValidJob valid = gash.withEdges(flutes, std::vector<EdgeHelix>(job.tooth_angles.size()));
  double strokes = 0;
  for (const JobPass& pass : valid.passes()) {
    const FaceStroke stroke = valid.faceStroke(pass.place.tooth, valid.deepest(), 0);
    strokes += (stroke.to - stroke.from).head<3>().matrix().norm() / job.process().feed;
  }
  Machine machine = roomyMachine();
  machine.max_job_duration = 1;
  const JobPlan plan = planJob(valid, machine, machine.park);
  ASSERT_EQ(plan.fault, PlanFault::kTooLong) << textOf(plan);
  EXPECT_LT(plan.reasons[0].value, strokes);
  EXPECT_GT(plan.reasons[0].value, 0.8 * strokes);
}

TEST(JobPlan, RefusesAJobOnceItTakesTooLong) {
  Machine machine = plainMachine();
  const double whole = planOf(paperJob()).statistics.duration;
  machine.max_job_duration = whole + 1e-6;
  EXPECT_TRUE(planOf(paperJob(), machine).good());
  machine.max_job_duration = whole - 2 * machine.period;
  std::vector<Setpoint> visited;
  const JobPlan plan =
      planJob(ValidJob(paperJob()), machine, machine.park, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.fault, PlanFault::kTooLong);
  ASSERT_EQ(plan.reasons.size(), 1u);
  EXPECT_EQ(plan.reasons[0].kind, ReasonKind::kTooLong);
  EXPECT_EQ(plan.reasons[0].value, 0) << "it is not known how long it takes";
  EXPECT_EQ(plan.reasons[0].count, 1u);
  EXPECT_LE(static_cast<double>(visited.back().cycle) * machine.period, whole);
}

TEST(JobPlan, CountsOnlyThePassesThatAreLeft) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 2};
  job.process().spark_out = 4;
  Machine machine = plainMachine();
  machine.max_job_duration = planOf(job).statistics.duration * 0.7;
  for (const GrindOrder order : {GrindOrder::kToothMajor, GrindOrder::kPassMajor}) {
    job.process().order = order;
    EXPECT_EQ(planOf(job, machine).fault, PlanFault::kTooLong);
    const ToothPass half = order == GrindOrder::kToothMajor ? ToothPass{1, 0} : ToothPass{1, 2};
    const JobPlan plan = planJob(ValidJob(job), machine, {machine.park, half});
    EXPECT_TRUE(plan.good()) << textOf(plan);
  }
}

TEST(JobPlan, AsksItsWatchAllTheTime) {
  GrindJob job = paperJob();
  job.process().spark_out = 9;
  const Machine machine = plainMachine();
  std::uint64_t visited = 0;
  std::uint64_t seen = 0;
  std::uint64_t longest = 0;
  std::vector<double> done;
  const JobPlan plan = planJob(
      ValidJob(job), machine, machine.park, [&](const Setpoint&) { ++visited; },
      [&](double part) {
        longest = std::max(longest, visited - seen);
        seen = visited;
        done.push_back(part);
        return true;
      });
  ASSERT_TRUE(plan.good()) << textOf(plan);
  EXPECT_LE(std::max(longest, visited - seen), 5000u);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_LE(done.front(), 0.01);
  EXPECT_GT(done.back(), 0.8);
  EXPECT_LE(done.back(), 1);
}

/// D1 1.6 mm, C 15 deg and next to no spiral, with an overtravel up to next to the apex.
GrindJob apexJob(double short_of_apex, double spiral_deg) {
  GrindJob job = paperJob();
  job.cutter.end_diameter = 1.6e-3;
  job.cutter.cone_angle = 15 * units::kDegree;
  job.cutter.spiral_angle = spiral_deg * units::kDegree;
  job.process().depth = job.process().infeed = 0.1e-3;
  job.process().overtravel_end = 0.8e-3 / std::tan(job.cutter.cone_angle) * (1 - short_of_apex);
  return job;
}

// Steps far longer than the way to the apex made the path nan, and that ended the process where the stroke's did.
TEST(JobPlan, GoesNoFartherTowardAnApexThanItsStepsHold) {
  struct Apex {
    double short_of_apex, spiral_deg, feed_mm_min, tolerance, scale;
    StrokeDirection direction;
    EvenStepRule rule;
  };
  const Apex all[]{{1.2e-4, 9.9e-4, 4104, 1.3e-9, 0.227, StrokeDirection::kToEnd, EvenStepRule::kPublished},
                   {2.6e-5, 2.8e-4, 3921, 1.5e-6, 0.035, StrokeDirection::kToEnd, EvenStepRule::kPublished},
                   {5.6e-4, 7e-4, 9059, 1.1e-10, 0.266, StrokeDirection::kToEnd, EvenStepRule::kPublished},
                   {7.3e-4, 4.2e-4, 1055, 3.4e-10, 0.21, StrokeDirection::kFromEnd, EvenStepRule::kThirdOrder},
                   {1.3e-6, 2e-6, 5634, 6.8e-9, 0.161, StrokeDirection::kFromEnd, EvenStepRule::kThirdOrder},
                   {1e-6, 1e-6, 600, 1e-6, 1e-3, StrokeDirection::kFromEnd, EvenStepRule::kPublished}};
  for (const Apex& apex : all) {
    SCOPED_TRACE(apex.short_of_apex);
    GrindJob job = apexJob(apex.short_of_apex, apex.spiral_deg);
    job.cutter.flute_length = 0.5e-3;
    job.process().feed = apex.feed_mm_min * units::kMillimetrePerMinute;
    job.process().direction = apex.direction;
    job.interpolation = {apex.rule, apex.tolerance, apex.scale};
    ASSERT_TRUE(validate(job).empty());
    for (const Machine& machine : {plainMachine(), strongMachine()}) {
      bool finite = true;
      const JobPlan plan = planJob(ValidJob(job), machine, machine.park,
                                   [&](const Setpoint& p) { finite &= p.position.isFinite().all(); });
      EXPECT_TRUE(finite);
      EXPECT_EQ(plan.good(), plan.reasons.empty());
      EXPECT_FALSE(contains(textOf(plan), "nan")) << textOf(plan);
    }
  }
}

TEST(JobPlan, NamesTheControlRateWhereTheApexIsTooNear) {
  GrindJob job = apexJob(1e-6, 0);
  const JobPlan plan = planOf(job, strongMachine());
  EXPECT_EQ(plan.fault, PlanFault::kInvalidJob);
  // An eighth of the 0.8 um / tan 15 deg of radius left, each millisecond: 22.4 um/min.
  EXPECT_TRUE(contains(textOf(plan), "process.feed_mm_min: control rate allows 0.023")) << textOf(plan);
  EXPECT_TRUE(contains(textOf(plan), "at X = -2.985")) << textOf(plan);
}

TEST(JobPlan, RefusesPublishedWhereTheFeedOverrideWouldLeaveTheTolerance) {
  GrindJob job = steepJob();
  job.process().feed = 600 * units::kMillimetrePerMinute;
  const auto deviationAt = [&](double override_fraction) {
    SetpointStream stream(GrindProgram(ValidJob(job), strongMachine(), strongMachine().park));
    stream.setFeedOverride(override_fraction);
    const ConicalCutter cutter(job.cutter);
    double max = 0;
    for (Setpoint p; stream.next(p);) {
      const double deviation = std::abs(p.path_error) * cutter.radius(p.position[kX]) * cutter.cosHelixToGeneratrix();
      max = std::max(max, deviation);
    }
    return max;
  };
  job.interpolation.tolerance = 1e-6;  // not in the way
  const double at_feed = deviationAt(1);
  const double at_fastest = deviationAt(kMaxFeedOverride);
  ASSERT_GT(at_fastest, 1.3 * at_feed);
  job.interpolation.tolerance = 0.97 * at_fastest;
  EXPECT_EQ(planOf(job, strongMachine()).fault, PlanFault::kTolerance);
  job.interpolation.tolerance = 1.03 * 1.44 * at_feed;
  EXPECT_TRUE(planOf(job, strongMachine()).good());
  EXPECT_LE(deviationAt(kMaxFeedOverride), job.interpolation.tolerance);
}

TEST(JobPlan, TakesTheOtherRulesWherePublishedDriftsOff) {
  GrindJob job = steepJob();
  job.process().feed = 0.1;
  job.interpolation.tolerance = 0.2e-6;
  for (const EvenStepRule rule : {EvenStepRule::kThirdOrder, EvenStepRule::kExact}) {
    job.interpolation.even_step = rule;
    const JobPlan plan = planOf(job, strongMachine());
    EXPECT_TRUE(plan.good()) << toString(rule) << ": " << textOf(plan);
    EXPECT_EQ(causesOf(plan.statistics.feed_limits), "interpolation tolerance");
    EXPECT_LE(plan.statistics.max_deviation, 0.2e-6);
    EXPECT_GT(plan.statistics.max_deviation, 0.18e-6);
  }
}

// A cylinder's A takes all of its jerk limit. With a shift, its positions are small between turns that are not, from
// which they are computed: their rounding is that of the turns.
TEST(JobPlan, LetsTheRoundingPassOfAShift) {
  GrindJob job = paperJob();
  job.cutter.end_diameter = job.cutter.shank_diameter = 0.3e-3;
  job.cutter.cone_angle = 0;
  job.cutter.spiral_angle = -60 * units::kDegree;
  job.cutter.flute_length = 0.41e-3;
  job.cutter.core_diameter = job.cutter.core_diameter_end = 0.285e-3;
  job.process().depth = job.process().infeed = 7.5e-6;
  job.process().clearance = 0.1e-3;
  job.process().overtravel_end = job.process().overtravel_shank = 0;
  job.process().feed = 1e-3;
  job.process().direction = StrokeDirection::kToEnd;
  job.interpolation.rotary_scale = 0.1e-3;
  Machine machine = test_support::plainMachine();
  machine.limits.max_velocity << 0.02, 0.02, 0.02, 3;
  machine.limits.max_acceleration << 0.2, 0.2, 0.2, 30;
  machine.limits.max_jerk << 5, 5, 5, 300;
  machine.park << 0.2e-3, 0.2e-3, 0, 0;
  for (int i = 0; i < 20; ++i) {
    job.process().setup_x_shift = (0.38 + i * 1e-3) * 1e-3;
    machine.period = (0.78 + i * 1e-3) * 1e-3;
    const JobPlan plan = planOf(job, machine);
    EXPECT_TRUE(plan.good()) << i << ": " << textOf(plan);
  }
}

RC_GTEST_PROP(JobPlanProperty, ExactIsNeverRefusedForTheTolerance, ()) {
  Work work = *test_support::work(2000);
  work.job.interpolation.even_step = EvenStepRule::kExact;
  const JobPlan plan = planJob(work.valid(), work.machine, work.start);
  RC_ASSERT(plan.fault != PlanFault::kTolerance);
  RC_ASSERT(plan.statistics.max_deviation <= work.job.interpolation.tolerance);
}

}  // namespace test_job_plan
}  // namespace grinder
