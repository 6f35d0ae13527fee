#include "control/checks.h"
#include "control/paper_job.h"
#include "control/rig.h"

#include <algorithm>

// What an operator does to a running job: hold, resume and retract.
namespace grinder::test_support {
namespace test_hold_and_retract {

// ---------------------------------------------------------------------------------------------------------------------
// Hold and resume

class HoldAt : public testing::TestWithParam<Moment> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig_.runToCycle(GetParam().cycle() - 1));
    before_ = rig_.log.size();
    ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  }

  Rig<SimulatedDrive> rig_;
  std::size_t before_ = 0;  ///< samples before the request
};

TEST_P(HoldAt, StopsAsAStreamHeldInTheSameCycleStandsAndGoesOnToTheEnd) {
  if (rig_.last().state != S::kHeld) rig_.runUntil(S::kHeld);
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), allSetpoints(paperFromPark(), GetParam().cycle())));
  for (std::size_t i = before_; i + 1 < rig_.log.size(); ++i) {
    ASSERT_EQ(rig_.log[i].state, S::kHolding);
    ASSERT_TRUE(rig_.log[i].has_setpoint);
  }
  const std::size_t held = rig_.log.size() - 1;
  rig_.run(500);
  EXPECT_TRUE(atRestFrom(rig_.log, held));
  EXPECT_EQ(rig_.last().state, S::kHeld);
  EXPECT_EQ(rig_.jobsEnded(), 0);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  if (rig_.jobsEnded() == 0) {
    EXPECT_EQ(rig_.last().state, S::kRunning) << "it never left the path";
    rig_.runToEnd();
  }
  expectCompleted(rig_);
}

TEST_P(HoldAt, ResumeBeforeItRestsGoesOnWithoutARest) {
  if (rig_.last().state == S::kHeld) return;  // the move's last pair was under way
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.runToEnd();
  expectCompleted(rig_);
  for (std::size_t i = before_; i + 1 < rig_.log.size(); ++i) ASSERT_TRUE(rig_.log[i].has_setpoint) << "sample " << i;
}

INSTANTIATE_TEST_SUITE_P(, HoldAt, testing::ValuesIn(moments({0, 300, 500, 990})), momentName);

TEST(Hold, AfterTheLastSetpointStillLetsTheJobEnd) {
  for (const int before_end : {0, 1, 2, 3}) {
    Rig<FakeDrive> rig;
    rig.cycle();
    rig.startPaper();
    rig.runToCycle(planned().back().cycle - static_cast<std::uint64_t>(before_end));
    ASSERT_TRUE(rig.ask(E::kHold).accepted) << before_end;
    if (rig.last().state != S::kHeld) rig.runUntil(S::kHeld);
    EXPECT_EQ(rig.jobsEnded(), 0);
    ASSERT_TRUE(rig.ask(E::kResume).accepted);
    if (rig.jobsEnded() == 0) rig.runToEnd();
    expectCompleted(rig);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Retract

class RetractAt : public testing::TestWithParam<Moment> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig_.runToCycle(GetParam().cycle() - 1));
    ASSERT_NO_FATAL_FAILURE(rig_.hold());
    rig_.run(10);
    held_ = rig_.log.size() - 1;
    ASSERT_NO_FATAL_FAILURE(rig_.retract());
  }

  Rig<SimulatedDrive> rig_;
  std::size_t held_ = 0;  ///< last sample before the request
};

TEST_P(RetractAt, LiftsTheWheelUntilItIsClearStaysThereAndGoesBackToThePath) {
  for (std::size_t i = held_ + 1; i + 1 < rig_.log.size(); ++i) {
    ASSERT_EQ(rig_.log[i].state, S::kRetracting);
    ASSERT_TRUE(rig_.log[i].has_setpoint);
  }
  EXPECT_NEAR(rig_.last().command[kY], std::max(rig_.log[held_].command[kY], kClearanceHeight), 1e-12);
  const std::size_t lifted = rig_.log.size() - 1;
  rig_.run(300);
  EXPECT_EQ(rig_.last().state, S::kRetracted);
  EXPECT_TRUE(atRestFrom(rig_.log, lifted));
  EXPECT_EQ(rig_.jobsEnded(), 0);
  const std::size_t resumed = rig_.log.size();
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  if (rig_.jobsEnded() == 0) rig_.runToEnd();
  expectCompleted(rig_);
  bool running = false;
  for (std::size_t i = resumed; i + 1 < rig_.log.size(); ++i) {
    running |= rig_.log[i].state == S::kRunning;
    ASSERT_EQ(rig_.log[i].state, running ? S::kRunning : S::kResuming) << "sample " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(, RetractAt, testing::ValuesIn(moments({0, 300, 990})), momentName);

/// A number of cycles into the lift off the work, or into the way back.
class OnTheDetour : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { bringTo(rig_, S::kRetracting); }

  Rig<FakeDrive> rig_;
};

TEST_P(OnTheDetour, HoldWhileRetractingStopsTheLiftAndRetractLiftsTheRest) {
  rig_.run(GetParam());
  ASSERT_EQ(rig_.last().state, S::kRetracting);
  ASSERT_NO_FATAL_FAILURE(rig_.hold());
  const std::size_t held = rig_.log.size() - 1;
  rig_.run(200);
  EXPECT_TRUE(atRestFrom(rig_.log, held));
  EXPECT_LT(rig_.last().command[kY], kClearanceHeight - 1e-4);
  EXPECT_TRUE(smooth(rig_.log));
  ASSERT_TRUE(rig_.ask(E::kRetract).accepted);
  EXPECT_EQ(rig_.last().state, S::kRetracting);
  rig_.runUntil(S::kRetracted);
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_P(OnTheDetour, HoldWhileResumingStopsAndGoesOnOrRetractsAgain) {
  rig_.runUntil(S::kRetracted);
  for (const bool retracts : {true, false}) {
    ASSERT_TRUE(rig_.ask(E::kResume).accepted);
    rig_.run(4 * GetParam());
    ASSERT_EQ(rig_.last().state, S::kResuming);
    ASSERT_NO_FATAL_FAILURE(rig_.hold());
    const std::size_t held = rig_.log.size() - 1;
    rig_.run(100);
    EXPECT_TRUE(atRestFrom(rig_.log, held));
    if (!retracts) break;
    ASSERT_NO_FATAL_FAILURE(rig_.retract());
    EXPECT_GE(rig_.last().command[kY], kClearanceHeight - 1e-12);
  }
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  EXPECT_EQ(rig_.last().state, S::kResuming);
  rig_.runToEnd();
  expectCompleted(rig_);
}

INSTANTIATE_TEST_SUITE_P(AfterCycles, OnTheDetour, testing::Values(1, 2, 3, 10, 25, 50, 75, 76));

}  // namespace test_hold_and_retract
}  // namespace grinder::test_support
