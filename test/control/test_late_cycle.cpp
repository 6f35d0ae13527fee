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

class LateWhileMovingIn : public testing::TestWithParam<S> {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(bringTo(rig_, GetParam()));
    rig_.run(20);
    ASSERT_EQ(rig_.last().state, GetParam());
    ASSERT_TRUE(rig_.last().has_setpoint);
  }

  Rig<FakeDrive> rig_{patient()};
};

TEST_P(LateWhileMovingIn, BeyondTheLimitIsAFault) {
  const CycleSample& sample = rig_.cycle(52);
  EXPECT_EQ(sample.state, S::kFault);
  EXPECT_EQ(sample.fault.kind, FaultKind::kLate);
  EXPECT_EQ(sample.fault.text(), "the control loop came 0.052 s after the cycle before, allowed 0.01 s");
  EXPECT_FALSE(sample.has_setpoint);
  EXPECT_FALSE(rig_.drive.written_drive.enable);
}

TEST_P(LateWhileMovingIn, AtTheLimitIsNone) { EXPECT_NE(rig_.cycle(10).state, S::kFault); }

TEST_P(LateWhileMovingIn, ComesAfterTheEmergencyStop) {
  rig_.drive.status.emergency_stop = true;
  EXPECT_EQ(rig_.cycle(52).fault.kind, FaultKind::kEmergencyStop);
}

INSTANTIATE_TEST_SUITE_P(, LateWhileMovingIn,
                         testing::Values(S::kRunning, S::kHolding, S::kRetracting, S::kResuming, S::kCanceling,
                                         S::kLifting, S::kJogging, S::kJoggingRetracted),
                         [](const testing::TestParamInfo<S>& info) { return std::string(toString(info.param)); });

class LateAtRestIn : public testing::TestWithParam<S> {};

TEST_P(LateAtRestIn, IsNoFault) {
  LoopConfig config = patient();
  config.spindle_timeout = config.homing_timeout = 100;
  Rig<FakeDrive> rig(config);
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, GetParam()));
  rig.cycle();
  EXPECT_EQ(rig.cycle(900).state, GetParam());
}

INSTANTIATE_TEST_SUITE_P(, LateAtRestIn,
                         testing::Values(S::kDisabled, S::kReady, S::kHoming, S::kStarting, S::kHeld, S::kRetracted),
                         [](const testing::TestParamInfo<S>& info) { return std::string(toString(info.param)); });

TEST(LateCycle, IsNothingToADriveThatHasCommandsWaiting) {
  Rig<FakeDrive> late(patient()), punctual(patient());
  for (Rig<FakeDrive>* rig : {&late, &punctual}) {
    ASSERT_NO_FATAL_FAILURE(bringTo(*rig, S::kRunning));
    rig->drive.status.commands_waiting = 1;  // within the following error
  }
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
      Rig<FakeDrive> rig(patient());
      ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
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

TEST(LateCycle, JustBelowTwoPeriodsIsNotLate) {
  Rig<FakeDrive> rig(patient()), punctual(patient());
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRunning));
  ASSERT_NO_FATAL_FAILURE(bringTo(punctual, S::kRunning));
  rig.cycle(1.99);
  punctual.cycle();
  rig.run(10);
  punctual.run(10);
  EXPECT_TRUE(sameBits(rig.last().command, punctual.last().command));
}

class LateWithoutTheJob : public testing::TestWithParam<S> {};

TEST_P(LateWithoutTheJob, TheAxisTakesItsSpeedUpAnewToo) {
  Rig<FakeDrive> rig(patient());
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, GetParam()));
  rig.run(20);
  const auto y_step = [&](std::size_t back) {
    const std::size_t i = rig.log.size() - 1 - back;
    return rig.log[i].command[kY] - rig.log[i - 1].command[kY];
  };
  if (rig.last().setpoint.cycle % 2 == 1) rig.cycle();
  const double before = y_step(0);
  rig.cycle(5);
  rig.cycle();
  EXPECT_LT(y_step(0), before / 5 + 2e-6);
  rig.runUntil(GetParam() == S::kJoggingRetracted ? S::kRetracted : S::kReady);
  EXPECT_FALSE(rig.last().wheel_in_work);
}

INSTANTIATE_TEST_SUITE_P(, LateWithoutTheJob, testing::Values(S::kLifting, S::kJogging, S::kJoggingRetracted),
                         [](const testing::TestParamInfo<S>& info) { return std::string(toString(info.param)); });

}  // namespace test_late_cycle
}  // namespace grinder::test_support
