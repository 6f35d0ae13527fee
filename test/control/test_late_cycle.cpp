#include "control/rig.h"

#include <cmath>

// Late cycles.
namespace grinder::test_support {
namespace test_late_cycle {

/// Allows stale positions for long, so that only the lateness itself is a fault.
LoopConfig patient() {
  LoopConfig config = machineConfig();
  config.feedback_timeout = 1;
  return config;
}

TEST(LateCycle, BeyondTheLimitIsAFaultWhileTheAxesMove) {
  for (const S state : {S::kRunning, S::kHolding, S::kRetracting, S::kResuming, S::kCanceling, S::kLifting, S::kJogging,
                        S::kJoggingRetracted}) {
    for (const double periods : {10.0, 52.0}) {
      SCOPED_TRACE(testing::Message() << periods << " periods in " << toString(state));
      RigIn rig(state, patient());
      ASSERT_EQ(rig.run(20).state, state);
      ASSERT_TRUE(rig.last().has_setpoint);
      const CycleSample& sample = rig.cycle(periods);
      if (periods == 10) {
        EXPECT_NE(sample.state, S::kFault) << "at the limit";
        continue;
      }
      EXPECT_EQ(sample.state, S::kFault);
      EXPECT_EQ(sample.fault.kind, FaultKind::kLate);
      EXPECT_EQ(sample.fault.text(), "the control loop came 0.052 s after the cycle before, allowed 0.01 s");
      EXPECT_FALSE(sample.has_setpoint);
      EXPECT_FALSE(rig.drive.written_drive.enable);
    }
  }
}

TEST(LateCycle, IsNoFaultAtRest) {
  LoopConfig config = patient();
  config.spindle_timeout = config.homing_timeout = 100;
  for (const S state : {S::kDisabled, S::kReady, S::kHoming, S::kStarting, S::kHeld, S::kRetracted}) {
    RigIn rig(state, config);
    rig.cycle();
    EXPECT_EQ(rig.cycle(900).state, state);
  }
  Rig<FakeDrive> rig(config);
  ASSERT_NO_FATAL_FAILURE(rig.startPaper());
  EXPECT_EQ(rig.cycle(900).state, S::kRunning) << "its first setpoint is where the axes stand";
}

TEST(LateCycle, IsNothingToADriveThatHasCommandsWaiting) {
  RigIn late(S::kRunning, patient(), 1), punctual(S::kRunning, patient(), 1);
  late.drive.status.commands_waiting = punctual.drive.status.commands_waiting = 1;  // within the following error
  punctual.cycle();
  late.cycle(50);
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(late.last().state, S::kRunning) << late.last().fault.text();
    ASSERT_TRUE(sameBits(late.last().command, punctual.last().command));
    late.cycle();
    punctual.cycle();
  }
}

/// Distance that X goes in a cycle.
double step(const Rig<FakeDrive>& rig, std::size_t i) { return rig.log[i].command[kX] - rig.log[i - 1].command[kX]; }

TEST(LateCycle, BelowTheLimitTakesTheSpeedUpAnew) {
  for (const double periods : {2.0, 3.7, 10.0}) {
    for (const int phase : {0, 1}) {
      RigIn rig(S::kRunning, patient());
      rig.run(phase);
      const std::size_t full = rig.log.size() - 1;
      const double full_step = (step(rig, full) + step(rig, full - 1)) / 2;
      rig.cycle(periods);
      // Within a pair its second step is still made.
      if (rig.last().setpoint.cycle % 2 == 0) rig.cycle();
      rig.cycle();
      const std::size_t slow = rig.log.size() - 1;
      const double slow_step = (step(rig, slow) + step(rig, slow - 1)) / 2;
      // From there on up: by j t^3/6 at the most, as a mean over two cycles, in the first pair.
      EXPECT_NEAR(slow_step, full_step / periods, 10 * std::pow(0.002, 3) / 6 / 2 * 1.01) << periods << " periods";
      rig.run(400);
      const std::size_t again = rig.log.size() - 1;
      EXPECT_NEAR((step(rig, again) + step(rig, again - 1)) / 2, full_step, 1e-4 * full_step);
      rig.runToEnd();
      EXPECT_EQ(rig.loop->status().end, JobEnd::kDone) << rig.last().fault.text();
    }
  }
}

}  // namespace test_late_cycle
}  // namespace grinder::test_support
