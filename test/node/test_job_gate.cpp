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

TEST_F(JobGateTest, ACancelAheadOfTheStartKeepsItFromStarting) {
  for (const auto& cancel : {id("job"), kAll, id("", 10), id("", 11), id("another", 10)}) {
    open();
    EXPECT_EQ(gate_.cancel(cancel), cancel.id.empty() && cancel.stamp.isZero());
    EXPECT_TRUE(gate_.canceled());
    EXPECT_FALSE(start());
    gate_.close();
  }
  EXPECT_EQ(given_up_, 5);
  EXPECT_EQ(started_, 0);
}

TEST_F(JobGateTest, ACancelOfAnotherGoalIsNotForThisOne) {
  for (const auto& cancel : {id("another"), id("", 9), id("another", 9)}) {
    open();
    EXPECT_FALSE(gate_.cancel(cancel));
    EXPECT_FALSE(gate_.canceled());
    EXPECT_TRUE(start());
    EXPECT_FALSE(gate_.cancel(cancel));
    gate_.close();
  }
  EXPECT_EQ(given_up_, 0);
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

TEST_F(JobGateTest, AHoldAheadOfTheStartLatches) {
  open();
  EXPECT_TRUE(gate_.hold());
  EXPECT_TRUE(start());
  EXPECT_TRUE(held_);
  EXPECT_FALSE(gate_.hold()) << "from now on it is for the loop";
}

TEST_F(JobGateTest, ResumeTakesALatchedHoldBack) {
  open();
  EXPECT_FALSE(gate_.resume());
  EXPECT_TRUE(gate_.hold());
  EXPECT_TRUE(gate_.resume());
  EXPECT_TRUE(start());
  EXPECT_FALSE(held_);
  EXPECT_FALSE(gate_.resume()) << "from now on it is for the loop";
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
