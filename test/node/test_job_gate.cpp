#include "node/job_gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace grinder {
namespace test_job_gate {

actionlib_msgs::GoalID id(const std::string& name, double stamp = 0) {
  actionlib_msgs::GoalID id;
  id.id = name;
  id.stamp = ros::Time(stamp);
  return id;
}

const actionlib_msgs::GoalID kAll;

class JobGateTest : public testing::Test {
 protected:
  void open(const actionlib_msgs::GoalID& goal = id("job", 10)) {
    ASSERT_TRUE(gate_.open(goal, [this] { ++given_up_; }));
  }
  bool start() {
    return gate_.start([this](bool held) {
      ++started_;
      held_ = held;
    });
  }

  JobGate gate_;
  int given_up_ = 0;
  int started_ = 0;
  bool held_ = false;
};

TEST_F(JobGateTest, ACancelAheadOfTheStartKeepsItsGoalFromStarting) {
  const struct {
    actionlib_msgs::GoalID cancel;
    bool is_for_it;
  } rows[]{{id("job"), true},         {kAll, true},           {id("", 10), true}, {id("", 11), true},
           {id("another", 10), true}, {id("another"), false}, {id("", 9), false}, {id("another", 9), false}};
  for (const auto& row : rows) {
    open();
    EXPECT_EQ(gate_.cancel(row.cancel), row.is_for_it && row.cancel.id.empty() && row.cancel.stamp.isZero());
    EXPECT_EQ(gate_.canceled(), row.is_for_it);
    EXPECT_EQ(start(), !row.is_for_it);
    if (!row.is_for_it) {
      EXPECT_FALSE(gate_.cancel(row.cancel));
    }
    gate_.close();
  }
  EXPECT_EQ(given_up_, 5);
  EXPECT_EQ(started_, 3);
}

TEST_F(JobGateTest, ACancelAfterTheStartIsForTheLoopEveryTime) {
  open();
  ASSERT_TRUE(start());
  EXPECT_TRUE(gate_.cancel(id("job")));
  EXPECT_TRUE(gate_.cancel(id("job")));
  EXPECT_TRUE(gate_.cancel(kAll));
  EXPECT_EQ(given_up_, 0) << "its plan is done";
}

TEST_F(JobGateTest, ACancelOfTheLastGoalIsNotForTheNext) {
  open();
  ASSERT_TRUE(start());
  gate_.close();
  EXPECT_FALSE(gate_.cancel(id("job", 0)));
  open(id("next", 20));
  EXPECT_FALSE(gate_.canceled());
  EXPECT_FALSE(gate_.cancel(id("job")));
  EXPECT_TRUE(start());
}

TEST_F(JobGateTest, AHoldAheadOfTheStartLatchesUntilItIsTakenBack) {
  for (const bool resumed : {false, true}) {
    open();
    EXPECT_FALSE(gate_.resume());
    EXPECT_TRUE(gate_.hold());
    if (resumed) {
      EXPECT_TRUE(gate_.resume());
    }
    EXPECT_TRUE(start());
    EXPECT_EQ(held_, !resumed);
    EXPECT_FALSE(gate_.hold() || gate_.resume()) << "from now on they are for the loop";
    gate_.close();
  }
}

TEST_F(JobGateTest, AGoalStartsOnceAndNothingWithoutOneAndAHoldOfOneIsNotForTheNext) {
  open();
  EXPECT_TRUE(gate_.hold());
  gate_.close();
  EXPECT_FALSE(start());
  EXPECT_FALSE(gate_.hold());
  EXPECT_EQ(started_, 0);
  open(id("next", 20));
  EXPECT_TRUE(start());
  EXPECT_FALSE(held_);
  EXPECT_FALSE(start());
  EXPECT_EQ(started_, 1);
}

TEST_F(JobGateTest, OnceShutItStaysShut) {
  open();
  gate_.shut();
  EXPECT_EQ(given_up_, 1);
  EXPECT_FALSE(start());
  gate_.close();
  EXPECT_FALSE(gate_.open(id("next"), [] {}));
  EXPECT_FALSE(start());
}

TEST_F(JobGateTest, AJobAndAChangeOfTheOffsetsShutEachOtherOut) {
  ASSERT_TRUE(gate_.lockOutJobs());
  EXPECT_FALSE(gate_.open(id("job"), [] {}));
  EXPECT_FALSE(gate_.isShut());
  EXPECT_FALSE(start());
  gate_.letJobsIn();
  open();
  EXPECT_FALSE(gate_.lockOutJobs()) << "while it is planned";
  EXPECT_TRUE(start());
  EXPECT_FALSE(gate_.lockOutJobs()) << "while it runs";
  gate_.close();
  EXPECT_TRUE(gate_.lockOutJobs());
  gate_.letJobsIn();
  gate_.shut();
  EXPECT_TRUE(gate_.isShut());
}

/// Whatever comes first: either the job does not start, or the cancel is for the loop.
TEST_F(JobGateTest, NoCancelFallsBetweenPlanAndLoop) {
  for (int i = 0; i < 2000; ++i) {
    open();
    std::atomic<bool> go{false};
    bool for_loop = false;
    std::thread canceler([&] {
      while (!go) {
      }
      for_loop = gate_.cancel(id("job"));
    });
    go = true;
    const bool started = start();
    canceler.join();
    ASSERT_EQ(started, for_loop);
    gate_.close();
  }
}

}  // namespace test_job_gate
}  // namespace grinder
