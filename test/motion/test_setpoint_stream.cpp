#include "flute_grinder/motion/setpoint_stream.h"

#include "stream_checks.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace grinder {
namespace test_setpoint_stream {

using namespace test_support;

RC_GTEST_PROP(SetpointStreamProperty, CyclesCountFromZeroInPairsOddAndEvenByTurnsInStrokesOnly, ()) {
  const Work work = *test_support::work(kCycles);
  const auto setpoints = all(work);
  RC_ASSERT(setpoints.size() % 2 == 1u);  // the start, at rest, and then pairs
  RC_ASSERT((setpoints[0].position == work.start).all());
  RC_ASSERT((setpoints[0].velocity == 0).all() && setpoints[0].feed == 0);
  for (std::size_t i = 0; i < setpoints.size(); ++i) {
    const Setpoint& p = setpoints[i];
    RC_ASSERT(p.cycle == i);
    const bool ends = i > 0 && i + 1 < setpoints.size() && p.move_index != setpoints[i + 1].move_index;
    if (ends) RC_ASSERT(p.cycle % 2 == 0u);
    if (p.cycle == 0 || p.move != MoveKind::kStroke) {
      RC_ASSERT(p.step == StepKind::kNone);
      RC_ASSERT(p.path_error == 0);
      RC_ASSERT(!p.at_feed);
    } else {
      RC_ASSERT(p.step == (p.cycle % 2 == 1 ? StepKind::kOdd : StepKind::kEven));
    }
  }
}

RC_GTEST_PROP(SetpointStreamProperty, KeepsAllLimitsOfAllAxesAndReportsTheMeanVelocityOfTheCycle, ()) {
  const Work work = *test_support::work(kCycles);
  const auto setpoints = all(work);
  RC_ASSERT(beyondLimits(setpoints, work.machine) == "");
  for (std::size_t i = 1; i < setpoints.size(); ++i) {
    const Axes moved = setpoints[i].position - setpoints[i - 1].position;
    RC_ASSERT(((setpoints[i].velocity * work.machine.period - moved).abs() <= 4 * kEps * moved.abs()).all());
    // What turns A alone has no feed.
    RC_ASSERT(setpoints[i].feed <= 2 * work.machine.limits.max_velocity.head<3>().maxCoeff() ||
              setpoints[i].step != StepKind::kNone);
  }
}

RC_GTEST_PROP(SetpointStreamProperty, StrokesFollowThePapersConstructionAndReportTheoryMinusCommanded, ()) {
  const Work work = *test_support::work(kCycles);
  const auto setpoints = all(work);
  RC_ASSERT(offTheConstruction(setpoints, work.job, 37) == "");
  const ReferenceCurve curve(work.job.cutter, work.job.process().setup_x_shift);
  const Axes noise = roundingOf(setpoints);
  for (const Setpoint& p : setpoints) {
    if (p.step == StepKind::kNone) continue;
    const Real error = curve.a(p.position[kX]) - Real(p.position[kA]);
    RC_ASSERT(std::abs(p.path_error - error) <= Real(4 * noise[kA] + 1e-15));
  }
}

TEST(SetpointStream, IsFinishedAtItsEndOnlyAndThenLeavesTheSetpointAsItWas) {
  SetpointStream stream(GrindProgram(ValidJob(paperJob()), plainMachine(), plainMachine().park));
  Setpoint p;
  EXPECT_EQ(stream.rest(), Rest::kNone);
  while (stream.next(p)) {
    const bool at_end = p.move == MoveKind::kReturn && p.move_fraction == 1 && p.cycle % 2 == 0;
    ASSERT_EQ(stream.rest(), at_end ? Rest::kEnd : Rest::kNone);
  }
  EXPECT_EQ(stream.rest(), Rest::kEnd);
  const Setpoint last = p;
  stream.retract();
  EXPECT_EQ(stream.rest(), Rest::kEnd);
  stream.resume();
  EXPECT_FALSE(stream.next(p));
  EXPECT_EQ(p.cycle, last.cycle);
  EXPECT_TRUE((p.position == last.position).all());
}

TEST(SetpointStream, BeginsWithTheToothAndPassOfItsFirstMove) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 2};
  job.process().spark_out = 2;
  SetpointStream stream(GrindProgram(ValidJob(job), plainMachine(), {plainMachine().park, {1, 2}}));
  Setpoint p;
  ASSERT_TRUE(stream.next(p));
  EXPECT_EQ(p.tooth, 1u);
  EXPECT_EQ(p.pass, 2u);
}

/// A move shorter than any rounding has no setpoints, and ends where it should all the same.
TEST(SetpointStream, EndsAMoveOfNextToNoLengthExactly) {
  GrindJob job = paperJob();
  job.process().overtravel_end = 0;  // so that A and X begin at 0
  Axes start = plainMachine().park;
  start[kA] = start[kX] = 1e-31;
  SetpointStream stream(GrindProgram(ValidJob(job), plainMachine(), start));
  Setpoint p;
  ASSERT_TRUE(stream.next(p) && stream.next(p));
  EXPECT_EQ(p.move, MoveKind::kApproach);
  EXPECT_EQ(p.position[kA], 0);
  EXPECT_EQ(p.position[kX], 0);
}

TEST(SetpointStream, SkippedToAnotherItGoesOnAsThat) {
  PaperStroke ride(-1e-3);
  for (const MoveKind kind : {MoveKind::kStroke, MoveKind::kReturn}) {
    while (ride.last().move != kind || ride.last().cycle % 2 == 1) ride.next();
    SetpointStream early = ride.stream();
    for (int i = 0; i < 100; ++i) ride.next();
    ASSERT_EQ(ride.last().move, kind);
    early.skip(ride.stream(), 100);
    Setpoint p;
    ASSERT_TRUE(ride.next() && early.next(p));
    EXPECT_EQ(p.cycle, ride.last().cycle);
    EXPECT_TRUE((p.position == ride.last().position).all());
    EXPECT_TRUE((p.velocity == ride.last().velocity).all());
  }
}

TEST(SetpointStream, ReportsMoveAndProgress) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 2};
  SetpointStream stream(GrindProgram(ValidJob(job), plainMachine(), plainMachine().park));
  const auto moves = stream.program().moves();
  Setpoint p;
  ASSERT_TRUE(stream.next(p));
  EXPECT_EQ(p.move_index, 0u);
  EXPECT_EQ(p.move_fraction, 0);
  Setpoint before = p;
  for (; stream.next(p); before = p) {
    if (p.move_index == before.move_index) {
      ASSERT_GE(p.move_fraction, before.move_fraction);
    } else {
      ASSERT_EQ(p.move_index, before.move_index + 1);
      ASSERT_EQ(before.move_fraction, 1);
      if (before.move != MoveKind::kStroke) {
        ASSERT_TRUE((before.position == moves[before.move_index].to).all());
      }
      ASSERT_LT(p.move_fraction, 0.5);
    }
    // Of a stroke that is not cut for an axis it is the way in X.
    if (p.step == StepKind::kEven) {
      ASSERT_NEAR(p.move_fraction, (p.position[kX] + 1e-3) / 32e-3, 1e-12);
    }
    if (p.move == MoveKind::kApproach) {
      const double from = moves[p.move_index - 1].to[kY];
      ASSERT_NEAR(p.move_fraction, (p.position[kY] - from) / (moves[p.move_index].to[kY] - from), 1e-12);
    }
  }
  EXPECT_EQ(p.move_index, moves.size() - 1);
  EXPECT_TRUE((before.position == plainMachine().park).all());
}

}  // namespace test_setpoint_stream
}  // namespace grinder
