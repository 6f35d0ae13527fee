#include "flute_grinder/core/job_plan.h"

#include "generators.h"
#include "reference.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace flute_grinder {
namespace {

using namespace test_support;

JobPlan planOf(const GrindJob& job, const Machine& machine = plainMachine()) {
  return planJob(job, machine, machine.park);
}

std::string textOf(const JobPlan& plan) {
  std::string text;
  for (const std::string& reason : plan.reasons) text += reason + "\n";
  return text;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The causes of all feed cuts.
std::string causesOf(const JobPlan& plan) {
  std::string causes;
  for (const FeedCut& cut : plan.statistics.feed_cuts) causes += (causes.empty() ? "" : ", ") + cut.cause;
  return causes;
}

/// The reasons that have a part.
std::vector<std::string> reasonsWith(const JobPlan& plan, const std::string& part) {
  std::vector<std::string> reasons;
  for (const std::string& reason : plan.reasons) {
    if (contains(reason, part)) reasons.push_back(reason);
  }
  return reasons;
}

/// A cutter on which `published` drifts off: D1 2 mm, C 15 deg, S 45 deg.
GrindJob steepJob() {
  GrindJob j = paperJob();
  j.cutter = {2e-3, 15 * units::kDegree, 45 * units::kDegree, 0, 20e-3};
  j.process.overtravel_end = 0;
  j.process.depth = j.process.infeed = 0.2e-3;
  return j;
}

/// Limits that hardly hinder a feed.
Machine strongMachine() {
  Machine m = plainMachine();
  m.limits.max_velocity *= 50;
  m.limits.max_acceleration *= 1000;
  m.limits.max_jerk *= 100000;
  return m;
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

/// Checks move_ends against the setpoints' own moves.
void expectMoveEnds(const GrindJob& job, const Machine& machine, const Axes& start, bool rc = false) {
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(job, machine, start, {}, [&](const Setpoint& p) { visited.push_back(p); });
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
  if (rc) {
    RC_ASSERT(plan.move_ends == expected);
    RC_ASSERT(plan.move_ends.back() + 1 == plan.statistics.setpoints);
  } else {
    EXPECT_EQ(plan.move_ends, expected);
    EXPECT_EQ(plan.move_ends.back() + 1, plan.statistics.setpoints);
  }
}

TEST(JobPlan, TellsWhereEveryMoveEnds) { expectMoveEnds(paperJob(), plainMachine(), plainMachine().park); }

TEST(JobPlan, TellsWhereMovesOfNoLengthEnd) {
  GrindJob job = paperJob();
  job.cutter.spiral_angle = 0;  // A never turns
  job.process.spark_out = 2;
  expectMoveEnds(job, plainMachine(), plainMachine().park);
}

RC_GTEST_PROP(JobPlanProperty, TellsWhereEveryMoveEnds, ()) {
  const Work work = *test_support::toothedWork(500);
  expectMoveEnds(work.job, work.machine, work.start, true);
}

RC_GTEST_PROP(JobPlanProperty, MovesTakeTheWholeTime, ()) {
  const Work work = *test_support::toothedWork(500);
  std::array<std::uint64_t, kMoveKindCount> cycles{};
  const JobPlan plan = planJob(work.job, work.machine, work.start, {}, [&](const Setpoint& p) {
    if (p.cycle > 0) ++cycles.at(static_cast<std::size_t>(p.move));
  });
  double sum = 0;
  for (std::size_t i = 0; i < kMoveKindCount; ++i) {
    const double duration = static_cast<double>(cycles[i]) * work.machine.period;
    RC_ASSERT(std::abs(plan.statistics.move_duration[i] - duration) <= 1e-9 * (1 + duration));
    sum += plan.statistics.move_duration[i];
  }
  RC_ASSERT(std::abs(sum - plan.statistics.duration) <= 1e-9 * (1 + sum));
}

/// Where the pairs' own feed is below the one asked for, apart from the ramps at the stroke's ends; in the order of the
/// stroke.
std::pair<double, double> slowRange(const JobPlan& plan, const std::vector<Setpoint>& setpoints) {
  const GrindJob& job = plan.program->job();
  const double period = plan.program->machine().period;
  const double edge = test_support::edgePerTravel(job.cutter);
  std::vector<double> slow;
  for (std::size_t i = 2; i < setpoints.size(); i += 2) {
    if (setpoints[i].step == StepKind::kNone) continue;
    const double x = setpoints[i].position[kX];
    const double before = setpoints[i - 2].position[kX];
    const double ramp = 0.2e-3;
    const bool ramps =
        std::min(std::abs(x - plan.program->strokeFrom()), std::abs(x - plan.program->strokeTo())) < ramp;
    if (!ramps && std::abs(x - before) / (2 * period) * edge < job.process.feed * (1 - 1e-4)) slow.push_back(x);
  }
  if (slow.empty()) return {0, 0};
  return {slow.front(), slow.back()};
}

TEST(JobPlan, TellsWhereTheFeedIsCut) {
  // 10 mm/s along the edge ask A for 1.015 rad/s at X = -1 mm and for 0.653 rad/s at 31 mm.
  for (const StrokeDirection direction : {StrokeDirection::kFromEnd, StrokeDirection::kToEnd}) {
    SCOPED_TRACE(toString(direction));
    GrindJob job = paperJob();
    job.process.direction = direction;
    Machine machine = strongMachine();
    machine.limits.max_velocity[kA] = 0.8;
    std::vector<Setpoint> visited;
    const JobPlan plan = planJob(job, machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
    ASSERT_TRUE(plan.good()) << textOf(plan);
    ASSERT_EQ(causesOf(plan), "axis_a velocity");
    const FeedCut& cut = plan.statistics.feed_cuts[0];
    const auto [from, to] = slowRange(plan, visited);
    const bool from_end = direction == StrokeDirection::kFromEnd;
    EXPECT_EQ(from_end ? cut.from : cut.to, -1e-3);
    EXPECT_NEAR(from_end ? cut.from : cut.to, from_end ? from : to, 0.3e-3);  // up to the ramp
    EXPECT_NEAR(from_end ? cut.to : cut.from, from_end ? to : from, 0.1e-3);
    // Where v k/u = 0.8 rad/s, by hand.
    const double growth = std::tan(5 * units::kDegree);
    const double x =
        (0.01 / test_support::edgePerTravel(job.cutter) * std::tan(30 * units::kDegree) / 0.8 - 5e-3) / growth;
    EXPECT_NEAR(from_end ? cut.to : cut.from, x, 0.1e-3);
  }
}

TEST(JobPlan, TellsThatTheFeedIsCutAllAlong) {
  GrindJob job = paperJob();
  Machine machine = strongMachine();
  machine.limits.max_velocity[kX] = 0.004;
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(job, machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
  ASSERT_EQ(causesOf(plan), "axis_x velocity");
  EXPECT_EQ(plan.statistics.feed_cuts[0].from, -1e-3);
  EXPECT_EQ(plan.statistics.feed_cuts[0].to, 31e-3);
  const auto [from, to] = slowRange(plan, visited);
  EXPECT_NEAR(from, -1e-3, 0.3e-3);
  EXPECT_NEAR(to, 31e-3, 0.3e-3);
}

TEST(JobPlan, OfThePapersJobIsGoodAndHasNoReasons) {
  const JobPlan plan = planOf(paperJob());
  EXPECT_TRUE(plan.good());
  EXPECT_EQ(plan.fault, PlanFault::kNone);
  EXPECT_TRUE(plan.reasons.empty());
  ASSERT_NE(plan.program, nullptr);
  EXPECT_EQ(causesOf(plan), "");
  EXPECT_NEAR(plan.statistics.min_feed, 0.01, 1e-8);
  EXPECT_NEAR(plan.statistics.max_feed, 0.01, 1e-8);
}

TEST(JobPlan, ReportsTheRippleOfTheOddEvenSteps) {
  // A turns by 2 kappa dl once per pair: |k b| v^2 / u^2 on the mean, twice that by single cycles, at X = -1 mm.
  const JobPlan plan = planOf(paperJob());
  const ReferenceCurve curve(paperJob().cutter);
  const Real speed = 0.01 / test_support::edgePerTravel(paperJob().cutter);
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

TEST(JobPlan, RefusesAJobThatTakesTooLongBeforeItIsMade) {
  // 64 teeth in 300 passes of 5 mm + 32 mm sqrt(1 + tan^2 5 + tan^2 30) at 0.1 mm/min: 42 mm each, 25,200 s.
  GrindJob job = paperJob();
  job.tooth_angles.clear();
  for (int i = 0; i < 64; ++i) job.tooth_angles.push_back(i * 0.09);
  job.process.infeed = job.process.depth / 300;
  job.process.feed = 0.1e-3 / 60;
  const Machine machine = plainMachine();
  int looks = 0;
  const JobPlan plan =
      planJob(job, machine, machine.park, {}, {}, UnitSystem::kShop, [&](double) { return ++looks > 0; });
  EXPECT_EQ(plan.fault, PlanFault::kTooLong);
  EXPECT_EQ(plan.program, nullptr);
  EXPECT_EQ(looks, 0);
  ASSERT_EQ(plan.reasons.size(), 1u);
  const double pass = (5 + 32 * test_support::edgePerTravel(job.cutter)) / 0.1 * 60;
  std::ostringstream text;
  text << "max_job_duration = 86400 s: the job takes " << 64 * 300 * pass
       << " s or more, with teeth 64, passes 300, process.feed_mm_min = 0.1 mm/min, process.infeed_mm = "
          "0.001666666667 mm; raise process.feed_mm_min or process.infeed_mm, or the parameter";
  EXPECT_EQ(plan.reasons[0], text.str());
}

TEST(JobPlan, RefusesAJobOnceItTakesTooLong) {
  Machine machine = plainMachine();
  const double whole = planOf(paperJob()).statistics.duration;
  machine.max_job_duration = whole + 1e-6;
  EXPECT_TRUE(planOf(paperJob(), machine).good());
  machine.max_job_duration = whole - 2 * machine.period;
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(paperJob(), machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.fault, PlanFault::kTooLong);
  ASSERT_EQ(plan.reasons.size(), 1u);
  EXPECT_TRUE(contains(plan.reasons[0], "max_job_duration = ")) << plan.reasons[0];
  EXPECT_TRUE(contains(plan.reasons[0],
                       " s: the job takes longer, with teeth 1, passes 1, process.feed = 0.01 m/s, process.infeed = "
                       "0.0005 m; raise process.feed or process.infeed, or the parameter"))
      << plan.reasons[0];
  EXPECT_LE(static_cast<double>(visited.back().cycle) * machine.period, whole);
}

TEST(JobPlan, CountsOnlyThePassesThatAreLeft) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 2};
  job.process.spark_out = 4;
  Machine machine = plainMachine();
  machine.max_job_duration = planOf(job).statistics.duration * 0.7;
  for (const GrindOrder order : {GrindOrder::kToothMajor, GrindOrder::kPassMajor}) {
    job.process.order = order;
    EXPECT_EQ(planOf(job, machine).fault, PlanFault::kTooLong);
    const ToothPass half = order == GrindOrder::kToothMajor ? ToothPass{1, 0} : ToothPass{1, 2};
    const JobPlan plan = planJob(job, machine, machine.park, half);
    EXPECT_TRUE(plan.good()) << textOf(plan);
  }
}

TEST(JobPlan, AsksItsWatchAllTheTime) {
  GrindJob job = paperJob();
  job.process.spark_out = 9;
  const Machine machine = plainMachine();
  std::uint64_t visited = 0;
  std::uint64_t seen = 0;
  std::uint64_t longest = 0;
  std::vector<double> done;
  const JobPlan plan = planJob(
      job, machine, machine.park, {}, [&](const Setpoint&) { ++visited; }, UnitSystem::kSi,
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

TEST(JobPlan, IsGivenUpByItsWatch) {
  const Machine machine = plainMachine();
  GrindJob job = paperJob();
  job.process.spark_out = 9;
  std::uint64_t visited = 0;
  int looks = 0;
  const JobPlan plan = planJob(
      job, machine, machine.park, {}, [&](const Setpoint&) { ++visited; }, UnitSystem::kSi,
      [&](double) { return ++looks < 3; });
  EXPECT_EQ(plan.fault, PlanFault::kGivenUp);
  EXPECT_EQ(looks, 3);
  EXPECT_EQ(visited, plan.statistics.setpoints);
  EXPECT_LE(visited, 10000u);
  ASSERT_EQ(plan.reasons.size(), 1u);
  EXPECT_TRUE(contains(plan.reasons[0], "given up"));
}

/// D1 1.6 mm, C 15 deg and next to no spiral, with an overtravel up to next to the apex.
GrindJob apexJob(double short_of_apex, double spiral_deg) {
  GrindJob job = paperJob();
  job.cutter.end_diameter = 1.6e-3;
  job.cutter.cone_angle = 15 * units::kDegree;
  job.cutter.spiral_angle = spiral_deg * units::kDegree;
  job.process.depth = job.process.infeed = 0.1e-3;
  job.process.overtravel_end = 0.8e-3 / std::tan(job.cutter.cone_angle) * (1 - short_of_apex);
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
    job.process.feed = apex.feed_mm_min * units::kMillimetrePerMinute;
    job.process.direction = apex.direction;
    job.interpolation = {apex.rule, apex.tolerance, apex.scale};
    ASSERT_TRUE(validate(job).empty());
    for (const Machine& machine : {plainMachine(), strongMachine()}) {
      bool finite = true;
      const JobPlan plan =
          planJob(job, machine, machine.park, {}, [&](const Setpoint& p) { finite &= p.position.isFinite().all(); });
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
  EXPECT_TRUE(contains(textOf(plan), "process.feed: control rate allows 3.8")) << textOf(plan);
  EXPECT_TRUE(contains(textOf(plan), "at X = -0.002985")) << textOf(plan);
}

/// What a plan should object to: setpoints beyond the upper limit of an axis, counted by moves.
struct Beyond {
  std::uint64_t count = 0;
  double worst = 0;
};

std::map<MoveKind, Beyond> beyondUpperLimit(const std::vector<Setpoint>& setpoints, int axis, double limit) {
  std::map<MoveKind, Beyond> moves;
  for (const Setpoint& p : setpoints) {
    if (p.position[axis] <= limit) continue;
    Beyond& beyond = moves[p.move];
    ++beyond.count;
    beyond.worst = std::max(beyond.worst, p.position[axis]);
  }
  return moves;
}

/// Whether a plan has one reason for each kind of move that is beyond the upper limit of an axis, with its worst and
/// the count, and no other for that axis.
void expectReasons(const JobPlan& plan, const std::vector<Setpoint>& setpoints, int axis, double limit) {
  const auto moves = beyondUpperLimit(setpoints, axis, limit);
  const std::string name = kJointNames[static_cast<std::size_t>(axis)];
  EXPECT_EQ(reasonsWith(plan, name).size(), moves.size()) << textOf(plan);
  for (const auto& [kind, beyond] : moves) {
    const auto reasons = reasonsWith(plan, std::string("(") + toString(kind) + ", cycle");
    std::string reason;
    for (const std::string& r : reasons) reason = contains(r, name) ? r : reason;
    std::ostringstream worst;
    worst << name << " position " << beyond.worst << ' ' << axisUnit(axis) << " is ";
    EXPECT_TRUE(contains(reason, worst.str())) << worst.str() << " in\n" << textOf(plan);
    std::ostringstream beyond_limit;
    beyond_limit << "beyond its limit " << limit << ' ' << axisUnit(axis);
    EXPECT_TRUE(contains(reason, beyond_limit.str())) << reason;
    const std::string others = "; the worst of " + std::to_string(beyond.count) + " setpoints";
    if (beyond.count > 1) {
      EXPECT_TRUE(contains(reason, others)) << others << " in\n" << reason;
    } else {
      EXPECT_FALSE(contains(reason, "worst of")) << reason;
    }
  }
}

TEST(JobPlan, RefusesAWayBeyondAnAxisLimitWithTheAmount) {
  Machine machine = plainMachine();
  machine.limits.max_position[kX] = 0.030;  // the stroke goes to 31 mm
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(paperJob(), machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  ASSERT_EQ(plan.reasons.size(), 3u) << textOf(plan);  // stroke, and retract and return from its end
  EXPECT_EQ(plan.reasons[0].find("axis_x position 0.031 m is 0.001 m beyond its limit 0.03 m (stroke, cycle "), 0u)
      << plan.reasons[0];
  expectReasons(plan, visited, kX, 0.030);
  // It goes through to the end.
  EXPECT_TRUE((visited.back().position == machine.park).all());
  EXPECT_EQ(plan.statistics.setpoints, visited.size());
}

TEST(JobPlan, TellsOfEveryAxisThatIsBeyondItsLimits) {
  Machine machine = plainMachine();
  machine.limits.max_position << 0.030, 0.04, 0.2, 2;
  machine.limits.min_position[kZ] = -1e-5;  // the stroke begins at -12 um
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(paperJob(), machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  expectReasons(plan, visited, kX, 0.030);
  expectReasons(plan, visited, kY, 0.04);
  expectReasons(plan, visited, kA, 2);
  std::set<MoveKind> low;
  for (const Setpoint& p : visited) {
    if (p.position[kZ] < -1e-5) low.insert(p.move);
  }
  EXPECT_EQ(low.size(), reasonsWith(plan, "axis_z").size()) << textOf(plan);
  EXPECT_FALSE(low.empty());
}

TEST(JobPlan, TellsOfASingleSetpointWithoutACount) {
  std::vector<double> xs;
  const auto see = [&](const Setpoint& p) {
    if (p.move == MoveKind::kStroke) xs.push_back(p.position[kX]);
  };
  Machine machine = plainMachine();
  planJob(paperJob(), machine, machine.park, {}, see);
  const double last = *std::max_element(xs.begin(), xs.end());
  xs.erase(std::remove(xs.begin(), xs.end(), last), xs.end());
  machine.limits.max_position[kX] = (last + *std::max_element(xs.begin(), xs.end())) / 2;
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(paperJob(), machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
  ASSERT_EQ(beyondUpperLimit(visited, kX, machine.limits.max_position[kX])[MoveKind::kStroke].count, 1u);
  const auto reasons = reasonsWith(plan, "(stroke, cycle");
  ASSERT_EQ(reasons.size(), 1u) << textOf(plan);
  EXPECT_FALSE(contains(reasons[0], "worst of")) << reasons[0];
}

TEST(JobPlan, TellsAllLimitsOfManyTeethInOneTextEach) {
  Machine machine = plainMachine();
  machine.limits.max_position[kX] = 0.030;
  GrindJob job = paperJob();
  job.tooth_angles = {0, 1, 2};
  job.process.spark_out = 1;
  std::vector<Setpoint> visited;
  const JobPlan plan = planJob(job, machine, machine.park, {}, [&](const Setpoint& p) { visited.push_back(p); });
  EXPECT_EQ(plan.reasons.size(), 5u) << textOf(plan);  // now index and position leave from beyond the limit too
  expectReasons(plan, visited, kX, 0.030);
}

TEST(JobPlan, RefusesATurnBeyondTheLimitOfA) {
  Machine machine = plainMachine();
  machine.limits.max_position[kA] = 2;
  const JobPlan plan = planOf(paperJob(), machine);
  EXPECT_EQ(plan.fault, PlanFault::kLimit);
  // It is at (tan S / tan C) ln(31 mm * 2 tan C / 10 mm + 1) at the end of the stroke.
  const double growth = std::tan(5 * units::kDegree);
  const double end = std::tan(30 * units::kDegree) / growth * std::log1p(31e-3 * 2 * growth / 10e-3);
  std::ostringstream text;
  text << "axis_a position " << end << " rad is ";
  EXPECT_TRUE(contains(textOf(plan), text.str())) << text.str() << " in\n" << textOf(plan);
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
  EXPECT_EQ(causesOf(published), "interpolation tolerance");
  EXPECT_GT(published.statistics.max_deviation, 0.2e-6);
}

TEST(JobPlan, RefusesPublishedWhereTheFeedOverrideWouldLeaveTheTolerance) {
  GrindJob job = steepJob();
  job.process.feed = 600 * units::kMillimetrePerMinute;
  const auto deviationAt = [&](double override_fraction) {
    SetpointStream stream(GrindProgram(job, strongMachine(), strongMachine().park));
    stream.setFeedOverride(override_fraction);
    const ConicalCutter cutter(job.cutter);
    double largest = 0;
    for (Setpoint p; stream.next(p);) {
      const double deviation = std::abs(p.path_error) * cutter.radius(p.position[kX]) * cutter.cosHelixToGeneratrix();
      largest = std::max(largest, deviation);
    }
    return largest;
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

TEST(JobPlan, TellsToleranceAndLimitsTogether) {
  GrindJob job = steepJob();
  job.process.feed = 0.1;
  job.interpolation.tolerance = 0.2e-6;
  Machine machine = strongMachine();
  machine.limits.max_position[kX] = 0.015;
  std::uint64_t off = 0;
  std::vector<Setpoint> visited;
  const Real normal =
      std::cos(std::atan(std::tan(Real(job.cutter.spiral_angle)) * std::cos(Real(job.cutter.cone_angle))));
  const ReferenceCurve curve(job.cutter);
  const JobPlan plan = planJob(job, machine, machine.park, {}, [&](const Setpoint& p) {
    visited.push_back(p);
    if (p.step == StepKind::kNone) return;
    const Real x = p.position[kX];
    const Real radius = Real(job.cutter.end_diameter) / 2 + x * std::tan(Real(job.cutter.cone_angle));
    if (std::abs(curve.a(x) - Real(p.position[kA])) * radius * normal > 0.2e-6L) ++off;
  });
  EXPECT_FALSE(plan.good());
  expectReasons(plan, visited, kX, 0.015);
  const auto tolerance = reasonsWith(plan, "interpolation.tolerance");
  ASSERT_EQ(tolerance.size(), 1u) << textOf(plan);
  ASSERT_GT(off, 1u);
  EXPECT_TRUE(contains(tolerance[0], "; the worst of " + std::to_string(off) + " setpoints")) << tolerance[0];
  std::ostringstream worst;
  worst << "deviates by " << plan.statistics.max_deviation << " m";
  EXPECT_TRUE(contains(tolerance[0], worst.str())) << tolerance[0];
  EXPECT_EQ(plan.reasons.size(), 1 + reasonsWith(plan, "axis_x").size());
}

TEST(JobPlan, TakesTheOtherRulesWherePublishedDriftsOff) {
  GrindJob job = steepJob();
  job.process.feed = 0.1;
  job.interpolation.tolerance = 0.2e-6;
  for (const EvenStepRule rule : {EvenStepRule::kThirdOrder, EvenStepRule::kExact}) {
    job.interpolation.even_step = rule;
    const JobPlan plan = planOf(job, strongMachine());
    EXPECT_TRUE(plan.good()) << toString(rule) << ": " << textOf(plan);
    EXPECT_EQ(causesOf(plan), "interpolation tolerance");
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
  EXPECT_EQ(causesOf(plan).find("axis_a"), 0u) << causesOf(plan);
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
  const Work work = *test_support::work(2000);
  const JobPlan plan = planJob(work.job, work.machine, work.start);
  RC_ASSERT(reasonsWith(plan, "axis_").empty());
  RC_ASSERT(plan.good() == plan.reasons.empty());
  RC_ASSERT(plan.good() || plan.fault == PlanFault::kTolerance);
  RC_ASSERT((plan.statistics.max_velocity <= work.machine.limits.max_velocity * (1 + 1e-6)).all());
}

RC_GTEST_PROP(JobPlanProperty, ExactIsNeverRefusedForTheTolerance, ()) {
  Work work = *test_support::work(2000);
  work.job.interpolation.even_step = EvenStepRule::kExact;
  const JobPlan plan = planJob(work.job, work.machine, work.start);
  RC_ASSERT(plan.fault != PlanFault::kTolerance);
  RC_ASSERT(plan.statistics.max_deviation <= work.job.interpolation.tolerance);
}

}  // namespace
}  // namespace flute_grinder
