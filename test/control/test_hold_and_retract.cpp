#include "control/paper_job.h"

#include <algorithm>
#include <limits>

// What an operator does to a running job: hold, resume, retract and feed override.
namespace grinder::test_support {
namespace test_hold_and_retract {

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

constexpr double kFeed = 0.010;  ///< of the paper's job [m/s]

TEST(FeedOverride, IsOneAtFirstTakesWhatIsInItsRangeAndRefusesTheRest) {
  Rig<FakeDrive> rig;
  EXPECT_EQ(rig.cycle().feed_override, 1);
  for (const double good : {0.0, 1.2, 0.5, 1.0, 0.7}) {
    EXPECT_TRUE(rig.loop->setFeedOverride(good)) << good;
    EXPECT_EQ(rig.cycle().feed_override, good);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nextafter(1.2, 2.0), std::nextafter(0.0, -1.0), -1.0, 50.0, infinity, -infinity,
                           std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(rig.loop->setFeedOverride(bad)) << bad;
    EXPECT_EQ(rig.cycle().feed_override, 0.7) << "after " << bad;
  }
}

TEST(FeedOverride, StaysForTheJobsToCome) {
  Rig<FakeDrive> rig;
  rig.startPaper();
  rig.runTo(MoveKind::kStroke);
  rig.loop->setFeedOverride(0.5);
  rig.runToEnd();
  rig.keepLast();
  ASSERT_NO_FATAL_FAILURE(rig.startPaper());
  rig.runTo(MoveKind::kStroke);
  rig.run(1000);
  EXPECT_EQ(rig.last().feed_override, 0.5);
  EXPECT_NEAR(rig.last().setpoint.feed, 0.5 * kFeed, 1e-6 * kFeed);
}

/// Rests at a feed override of 0, in the middle of the stroke.
class FeedOverrideOfZero : public testing::Test {
 protected:
  void SetUp() override {
    rig_.loop->setFeedOverride(0);
    for (int i = 0; i < 1000 && rig_.cycle().has_setpoint; ++i) {
    }
    ASSERT_FALSE(rig_.last().has_setpoint) << "does not come to rest";
    at_rest_ = rig_.log.size() - 1;
  }

  RigIn rig_{S::kRunning};
  std::size_t at_rest_ = 0;
};

TEST_F(FeedOverrideOfZero, RestsInStateRunningAndGoesOnWithAnother) {
  rig_.run(500);
  EXPECT_TRUE(atRestFrom(rig_.log, at_rest_));
  for (std::size_t i = at_rest_; i < rig_.log.size(); ++i) ASSERT_EQ(rig_.log[i].state, S::kRunning);
  EXPECT_EQ(rig_.last().feed_override, 0);
  EXPECT_EQ(rig_.jobsEnded(), 0);
  EXPECT_TRUE(rig_.drive.written_drive.spindle);
  rig_.loop->setFeedOverride(0.8);
  EXPECT_TRUE(rig_.cycle().has_setpoint);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_F(FeedOverrideOfZero, CanBeHeldAndResumed) {
  ASSERT_TRUE(rig_.ask(E::kHold).accepted);
  rig_.cycle();
  EXPECT_EQ(rig_.last().state, S::kHeld);
  rig_.loop->setFeedOverride(1);
  rig_.run(50);
  EXPECT_TRUE(atRestFrom(rig_.log, at_rest_)) << "the override moves what is held";
  rig_.loop->setFeedOverride(0);
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.run(50);
  EXPECT_EQ(rig_.last().state, S::kRunning);
  EXPECT_TRUE(atRestFrom(rig_.log, at_rest_));
  rig_.loop->setFeedOverride(1);
  rig_.runToEnd();
  expectCompleted(rig_);
}

TEST_F(FeedOverrideOfZero, CanBeRetractedAndRestsAboveTheWorkOnTheWayBack) {
  ASSERT_NO_FATAL_FAILURE(rig_.hold());
  ASSERT_NO_FATAL_FAILURE(rig_.retract());
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12) << "a lift is no feed";
  ASSERT_TRUE(rig_.ask(E::kResume).accepted);
  rig_.run(2000);
  EXPECT_EQ(rig_.last().state, S::kResuming);
  EXPECT_FALSE(rig_.last().has_setpoint);
  EXPECT_NEAR(rig_.last().command[kY], kClearanceHeight, 1e-12);
  rig_.loop->setFeedOverride(1);
  rig_.runToEnd();
  expectCompleted(rig_);
}

}  // namespace test_hold_and_retract
}  // namespace grinder::test_support
