#include "control/paper_job.h"

#include <limits>

// What an operator does to a running job: hold, resume, retract and feed override.
namespace grinder::test_support {
namespace test_hold_and_retract {

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

}  // namespace test_hold_and_retract
}  // namespace grinder::test_support
