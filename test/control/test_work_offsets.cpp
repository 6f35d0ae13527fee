#include "control/paper_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/job_plan.h"
#include "random_cases.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

// Jobs with work offsets: setpoints are the work's, commands, limits and heights the machine's.
namespace grinder::test_support {
namespace test_work_offsets {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

ValidJob paper() { return ValidJob(readJobFile("test/jobs/paper.yaml")); }

/// The paper's job from where the axes stand.
SetpointStream streamAt(const Axes& offset, const Axes& command, const LoopConfig& config = machineConfig()) {
  return paperStream(config.machine, {command, {}, offset});
}

/// With offsets for which the job stays within the machine's limits, and below the park position.
class WithOffsets : public testing::TestWithParam<int> {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }

  std::mt19937 random_{static_cast<unsigned>(GetParam())};
  Axes offset_{between(-0.09, 0.26), between(-0.018, 0.041), between(-0.049, 0.09), between(-120, 120)};
};
INSTANTIATE_TEST_SUITE_P(, WithOffsets, testing::Range(0, randomCases(30)));

/// Whether c is p + o, rounded once.
bool isSum(double c, double p, double o) {
  const long double sum = static_cast<long double>(p) + static_cast<long double>(o);
  return std::abs(static_cast<long double>(c) - sum) <= 0.5L * kUlp * std::abs(sum) + 1e-300L;
}

TEST_P(WithOffsets, SetpointsAreThePlansAndCommandsTheMachinesOfEachJobByItself) {
  Rig<FakeDrive> rig;
  rig.enable();
  for (const Axes& offset : {offset_, Axes(-0.05, -0.01, 0.03, -70)}) {
    SetpointStream stream = streamAt(offset, rig.last().command);
    const std::vector<Setpoint> planned = allSetpoints(stream);
    rig.keepLast();
    rig.start(stream);
    rig.runToEnd();
    ASSERT_EQ(rig.loop->status().end, JobEnd::kDone);
    ASSERT_TRUE(sameSetpoints(rig.setpoints(), planned));
    for (const CycleSample& sample : rig.log) {
      for (int axis = 0; axis < kAxisCount && sample.has_setpoint; ++axis) {
        ASSERT_TRUE(isSum(sample.command[axis], sample.setpoint.position[axis], offset[axis]));
      }
    }
    ASSERT_FALSE(rig.last().wheel_in_work);
    const Axes rounding = 2 * kUlp * (offset.abs() + 0.15);
    ASSERT_TRUE(((rig.last().command - machineConfig().machine.park).abs() <= rounding).all());
  }
}

/// With a part of the job's motion at a limit of the machine: axes that stand there, and a park position there.
TEST_P(WithOffsets, AJobAtALimitIsNotRefused) {
  LoopConfig config = machineConfig();
  AxisLimits& limits = config.machine.limits;
  config.machine.park << limits.min_position[kX], limits.max_position[kY], limits.min_position[kZ],
      limits.max_position[kA];
  // Where the stroke ends, by a sum that is rounded as badly as any.
  limits.max_position[kX] = kStrokeTo + offset_[kX];
  Rig<FakeDrive> rig(config);
  rig.enable();
  const JobPlan plan = planJob(paper(), config.machine, {rig.last().command, {}, offset_});
  ASSERT_TRUE(plan.good());
  SetpointStream stream(plan.program);
  rig.start(stream);
  rig.runToEnd();
  ASSERT_EQ(rig.loop->status().end, JobEnd::kDone);
  ASSERT_FALSE(rig.last().wheel_in_work);
  for (const CycleSample& sample : rig.log) {
    ASSERT_TRUE((sample.command <= limits.max_position).all());
    ASSERT_TRUE((sample.command >= limits.min_position).all());
  }
  ASSERT_TRUE(rig.jog({kX, false, 0.001, 0.01}).accepted);
}

TEST_P(WithOffsets, AJobBeyondALimitOfTheMachineIsRefusedWithTheMachinesFigures) {
  // Up to which only the stroke leaves it, and not the move to its start.
  const double beyond = between(1e-9, 0.037);
  offset_[kX] = 0.3 - kStrokeTo + beyond;
  const Machine machine = machineConfig().machine;
  const JobPlan plan = planJob(paper(), machine, {machine.park, {}, offset_});
  ASSERT_EQ(plan.fault, PlanFault::kLimit);
  const Reason& reason = plan.reasons.at(0);
  ASSERT_EQ(reason.kind, ReasonKind::kPosition);
  ASSERT_EQ(reason.axis, kX);
  EXPECT_NEAR(reason.value, 0.3 + beyond, 1e-12);
  ASSERT_EQ(reason.limit, 0.3);
  EXPECT_NEAR(reason.x, kStrokeTo, 1e-12);

  offset_[kX] -= 2 * beyond;
  ASSERT_TRUE(planJob(paper(), machine, {machine.park, {}, offset_}).good());
}

/// In the middle of a job too the limits are the machine's, and the height to which Y may go down with them.
TEST_P(WithOffsets, AJogInAJobEndsExactlyAtALimitAndMayTurnBack) {
  Rig<FakeDrive> rig;
  rig.enable();
  rig.stream.emplace(streamAt(offset_, rig.last().command));
  rig.start(*rig.stream);
  rig.runTo(MoveKind::kStroke);
  ASSERT_NO_FATAL_FAILURE(rig.hold());
  ASSERT_NO_FATAL_FAILURE(rig.retract());
  const AxisLimits limits = machineConfig().machine.limits;
  for (int i = 0; i < 6; ++i) {
    const int axis = static_cast<int>(random_() % 3);
    const bool up = random_() % 2 == 0;
    const double low = axis == kY ? rig.loop->status().wheel.clear_y : limits.min_position[axis];
    const double limit = up ? limits.max_position[axis] : low;
    if (rig.last().command[axis] == limit) continue;
    const double speed = limits.max_velocity[axis] * between(0.5, 1);
    const bool step = random_() % 2 == 0;
    if (step) {
      ASSERT_TRUE(rig.jog({axis, false, limit - rig.last().command[axis], speed}).accepted);
    }
    for (int cycle = 0; cycle < 20000 && (cycle < 50 || rig.last().state == S::kJoggingRetracted); ++cycle) {
      if (!step && cycle % 20 == 0) rig.loop->postJog({axis, true, 0, up ? speed : -speed});
      rig.cycle();
      static_cast<void>(rig.loop->jogReply());
      const double at = rig.last().command[axis];
      ASSERT_TRUE(up ? at <= limit : at >= limit) << at;
    }
    ASSERT_EQ(rig.last().state, S::kRetracted);
    ASSERT_EQ(rig.last().command[axis], limit);
    ASSERT_FALSE(rig.last().wheel_in_work);
    if (!step) {
      ASSERT_TRUE(rig.jog({axis, true, 0, 0}).accepted);
    }
    rig.run(100);
  }
  rig.keepLast();
  ASSERT_TRUE(rig.ask(E::kResume).accepted);
  rig.runToEnd();
  ASSERT_EQ(rig.loop->status().end, JobEnd::kDone);
}

TEST(WorkOffsets, DoNotCountForALiftByTheLoopOrANewOneAfterAFault) {
  Rig<FakeDrive> rig;
  rig.enable();
  rig.stream.emplace(streamAt({0.1, 0.0375, -0.02, 7}, rig.last().command));
  ASSERT_NO_FATAL_FAILURE(rig.start(*rig.stream));
  ASSERT_NO_FATAL_FAILURE(rig.runTo(MoveKind::kStroke));
  rig.run(1000);
  ASSERT_NO_FATAL_FAILURE(breakDown(rig));
  const Wheel wheel = rig.loop->status().wheel;
  EXPECT_NEAR(wheel.lift, kLift, 1e-15);
  Rig<FakeDrive> next(machineConfig(), wheel);
  EXPECT_TRUE(next.loop->status().wheel.in_work) << "before the first cycle";
  next.drive.place(rig.last().position);
  next.enable();
  ASSERT_NO_FATAL_FAILURE(rig.recover());
  for (Rig<FakeDrive>* one : {&rig, &next}) {
    const Axes from = one->last().command;
    EXPECT_TRUE(one->last().wheel_in_work);
    ASSERT_NO_FATAL_FAILURE(one->lift());
    EXPECT_TRUE(sameBits(one->last().command, Axes(from[kX], wheel.clear_y, from[kZ], from[kA])));
    EXPECT_NEAR(one->last().command[kY], kClearanceHeight + 0.0375, 1e-15);
    EXPECT_FALSE(one->last().wheel_in_work);
  }
}

TEST(WorkOffsets, MoveWhereACupIsClearButNotBeyondTheAxis) {
  const ValidJob end(readJobFile("jobs/left_hand_end_mill_d8_t3.yaml", "end_primary"));
  const ValidJob job = end.withEdges(ValidJob(end->ofOperation(0)), std::vector<EdgeHelix>(end->tooth_angles.size()));
  const Machine machine = machineConfig().machine;
  for (const double offset : {0.02, -1.0}) {
    const GrindProgram program(job, machine, {machine.park, {}, {offset, 0, 0, 0}});
    EXPECT_EQ(wheelOf(program).clear_x, offset > 0 ? program.clearX() + offset : machine.limits.min_position[kX]);
  }
}

TEST(WorkOffsets, TheParkPositionIsTheMachines) {
  const Axes offset(0, 0.045, 0, 0);
  const Machine machine = machineConfig().machine;
  const JobPlan plan = planJob(paper(), machine, {machine.park, {}, offset});
  ASSERT_EQ(plan.reasons.size(), 1u);
  EXPECT_EQ(plan.reasons[0].kind, ReasonKind::kParkInWork);
  EXPECT_EQ(plan.reasons[0].value, 0.05);
  EXPECT_NEAR(plan.reasons[0].limit, kClearanceHeight + 0.045, 1e-12);
}

TEST(WorkOffsets, UnknownOnesAreNoJobs) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1001.0}) {
    const Axes offset(0, 0, value, 0);
    EXPECT_FALSE(planJob(paper(), machineConfig().machine, {machineConfig().machine.park, {}, offset}).good()) << value;
  }
}

}  // namespace test_work_offsets
}  // namespace grinder::test_support
