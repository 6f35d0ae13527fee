#include "control/paper_job.h"

#include <limits>

// The feed override.
namespace grinder::test_support {
namespace test_feed_override {

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
  ASSERT_NO_FATAL_FAILURE(rig.startPaper());
  EXPECT_EQ(rig.loop->status().feed_override, 0.7) << "it stays for a job";
}

TEST(FeedOverride, OfZeroRestsInTheStrokeAndCanBeHeldAndResumed) {
  RigIn rig(S::kRunning);
  rig.loop->setFeedOverride(0);
  for (int i = 0; i < 1000 && rig.cycle().has_setpoint; ++i) {
  }
  ASSERT_FALSE(rig.last().has_setpoint) << "does not come to rest";
  const std::size_t at_rest = rig.log.size() - 1;
  ASSERT_TRUE(rig.ask(E::kHold).accepted);
  EXPECT_EQ(rig.cycle().state, S::kHeld);
  rig.loop->setFeedOverride(1);
  rig.run(50);
  EXPECT_TRUE(atRestFrom(rig.log, at_rest)) << "the override moves what is held";
  rig.loop->setFeedOverride(0);
  ASSERT_TRUE(rig.ask(E::kResume).accepted);
  EXPECT_EQ(rig.run(50).state, S::kRunning);
  EXPECT_TRUE(atRestFrom(rig.log, at_rest));
  rig.loop->setFeedOverride(1);
  rig.runToEnd();
  expectCompleted(rig);
}

}  // namespace test_feed_override
}  // namespace grinder::test_support
