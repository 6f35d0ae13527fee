#include "control/checks.h"
#include "control/paper_job.h"
#include "control/rig.h"

#include <algorithm>

// What an operator does to a running job: hold, resume and retract.
namespace grinder::test_support {
namespace test_hold_and_retract {

// ---------------------------------------------------------------------------------------------------------------------
// Hold and resume

TEST(HoldAt, AnyMomentStopsAsAStreamHeldInTheSameCycleAndGoesOnToTheEnd) {
  for (const Moment& moment : moments({0, 300, 500, 990})) {
    for (const bool rests : {true, false}) {
      SCOPED_TRACE(testing::Message() << moment << (rests ? "" : ", resumed before it rests"));
      Rig<SimulatedDrive> rig;
      rig.startPaper();
      ASSERT_NO_FATAL_FAILURE(rig.runToCycle(moment.cycle() - 1));
      const std::size_t before = rig.log.size();
      ASSERT_TRUE(rig.ask(E::kHold).accepted);
      if (!rests) {
        if (rig.last().state == S::kHeld) continue;  // the move's last pair was under way
        expectResumedAndCompleted(rig);
        for (std::size_t i = before; i + 1 < rig.log.size(); ++i) ASSERT_TRUE(rig.log[i].has_setpoint) << i;
        continue;
      }
      if (rig.last().state != S::kHeld) rig.runUntil(S::kHeld);
      EXPECT_TRUE(sameSetpoints(rig.setpoints(), allSetpoints(paperFromPark(), moment.cycle())));
      for (std::size_t i = before; i + 1 < rig.log.size(); ++i) {
        ASSERT_EQ(rig.log[i].state, S::kHolding);
        ASSERT_TRUE(rig.log[i].has_setpoint);
      }
      const std::size_t held = rig.log.size() - 1;
      rig.run(500);
      EXPECT_TRUE(atRestFrom(rig.log, held));
      EXPECT_EQ(rig.last().state, S::kHeld);
      EXPECT_EQ(rig.jobsEnded(), 0);
      ASSERT_TRUE(rig.ask(E::kResume).accepted);
      if (rig.jobsEnded() == 0) {
        EXPECT_EQ(rig.last().state, S::kRunning) << "it never left the path";
        rig.runToEnd();
      }
      expectCompleted(rig);
    }
  }
}

TEST(Hold, AfterTheLastSetpointStillLetsTheJobEnd) {
  for (const int before_end : {0, 1, 2, 3}) {
    Rig<FakeDrive> rig;
    rig.startPaper();
    rig.runToCycle(planned().back().cycle - static_cast<std::uint64_t>(before_end));
    ASSERT_TRUE(rig.ask(E::kHold).accepted) << before_end;
    if (rig.last().state != S::kHeld) rig.runUntil(S::kHeld);
    EXPECT_EQ(rig.jobsEnded(), 0);
    expectResumedAndCompleted(rig);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Retract

TEST(RetractAt, AnyMomentLiftsTheWheelUntilItIsClearStaysThereAndGoesBackToThePath) {
  for (const Moment& moment : moments({0, 300, 990})) {
    SCOPED_TRACE(moment);
    Rig<SimulatedDrive> rig;
    rig.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig.runToCycle(moment.cycle() - 1));
    ASSERT_NO_FATAL_FAILURE(rig.hold());
    rig.run(10);
    const std::size_t held = rig.log.size() - 1;
    ASSERT_NO_FATAL_FAILURE(rig.retract());
    for (std::size_t i = held + 1; i + 1 < rig.log.size(); ++i) {
      ASSERT_EQ(rig.log[i].state, S::kRetracting);
      ASSERT_TRUE(rig.log[i].has_setpoint);
    }
    EXPECT_NEAR(rig.last().command[kY], std::max(rig.log[held].command[kY], kClearanceHeight), 1e-12);
    const std::size_t lifted = rig.log.size() - 1;
    rig.run(300);
    EXPECT_EQ(rig.last().state, S::kRetracted);
    EXPECT_TRUE(atRestFrom(rig.log, lifted));
    EXPECT_EQ(rig.jobsEnded(), 0);
    const std::size_t resumed = rig.log.size();
    expectResumedAndCompleted(rig);
    bool running = false;
    for (std::size_t i = resumed; i + 1 < rig.log.size(); ++i) {
      running |= rig.log[i].state == S::kRunning;
      ASSERT_EQ(rig.log[i].state, running ? S::kRunning : S::kResuming) << "sample " << i;
    }
  }
}

/// Into the lift off the work, or into the way back.
constexpr int kCyclesIntoTheDetour[]{1, 2, 3, 10, 25, 50, 75, 76};

TEST(OnTheDetour, HoldWhileRetractingStopsTheLiftAndRetractLiftsTheRest) {
  for (const int cycles : kCyclesIntoTheDetour) {
    SCOPED_TRACE(cycles);
    RigIn rig(S::kRetracting);
    rig.run(cycles);
    ASSERT_EQ(rig.last().state, S::kRetracting);
    ASSERT_NO_FATAL_FAILURE(rig.hold());
    const std::size_t held = rig.log.size() - 1;
    rig.run(200);
    EXPECT_TRUE(atRestFrom(rig.log, held));
    EXPECT_LT(rig.last().command[kY], kClearanceHeight - 1e-4);
    EXPECT_TRUE(smooth(rig.log));
    ASSERT_NO_FATAL_FAILURE(rig.retract());
    EXPECT_NEAR(rig.last().command[kY], kClearanceHeight, 1e-12);
    expectResumedAndCompleted(rig);
  }
}

TEST(OnTheDetour, HoldWhileResumingStopsAndGoesOnOrRetractsAgain) {
  for (const int cycles : kCyclesIntoTheDetour) {
    SCOPED_TRACE(cycles);
    RigIn rig(S::kRetracted);
    for (const bool retracts : {true, false}) {
      ASSERT_TRUE(rig.ask(E::kResume).accepted);
      rig.run(4 * cycles);
      ASSERT_EQ(rig.last().state, S::kResuming);
      ASSERT_NO_FATAL_FAILURE(rig.hold());
      const std::size_t held = rig.log.size() - 1;
      rig.run(100);
      EXPECT_TRUE(atRestFrom(rig.log, held));
      if (!retracts) break;
      ASSERT_NO_FATAL_FAILURE(rig.retract());
      EXPECT_GE(rig.last().command[kY], kClearanceHeight - 1e-12);
    }
    ASSERT_TRUE(rig.ask(E::kResume).accepted);
    EXPECT_EQ(rig.last().state, S::kResuming);
    rig.runToEnd();
    expectCompleted(rig);
  }
}

}  // namespace test_hold_and_retract
}  // namespace grinder::test_support
