#include "control/checks.h"
#include "control/paper_job.h"
#include "control/rig.h"

#include <algorithm>
#include <tuple>

// Cancel.
namespace grinder::test_support {
namespace test_cancel {

class Cancel : public testing::TestWithParam<std::tuple<MoveKind, int>> {
 protected:
  void SetUp() override {
    rig_.cycle();
    rig_.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig_.runTo(std::get<0>(GetParam())));
    rig_.run(40 + std::get<1>(GetParam()));
    ASSERT_EQ(rig_.last().setpoint.move, std::get<0>(GetParam()));
    last_before_ = rig_.last().setpoint.cycle;
    ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
  }

  Rig<SimulatedDrive> rig_;
  std::uint64_t last_before_ = 0;
};

TEST_P(Cancel, StopsAsAStreamHeldInTheSameCycleLiftsTheWheelOffTheWorkAndIsReady) {
  EXPECT_EQ(rig_.last().state, S::kCanceling);
  const std::size_t from = rig_.log.size();
  rig_.runToEnd();
  for (std::size_t i = from; i + 1 < rig_.log.size(); ++i) ASSERT_EQ(rig_.log[i].state, S::kCanceling);
  EXPECT_EQ(rig_.last().state, S::kReady);
  SetpointStream stream = paperFromPark();
  EXPECT_LT(rig_.setpoints().size(), planned().size());
  std::vector<Setpoint> expected;
  Setpoint p;
  while (expected.size() <= last_before_ && stream.next(p)) expected.push_back(p);
  stream.hold();
  while (stream.next(p)) expected.push_back(p);
  if (expected.back().position[kY] < kClearanceHeight - 1e-12) {
    stream.retract();
    while (stream.next(p)) expected.push_back(p);
  }
  EXPECT_NEAR(std::min(expected.back().position[kY], kClearanceHeight), kClearanceHeight, 1e-12);
  EXPECT_TRUE(sameSetpoints(rig_.setpoints(), expected));
}

INSTANTIATE_TEST_SUITE_P(, Cancel,
                         testing::Combine(testing::Values(MoveKind::kIndex, MoveKind::kPosition, MoveKind::kApproach,
                                                          MoveKind::kInfeed, MoveKind::kStroke, MoveKind::kRetract,
                                                          MoveKind::kReturn),
                                          testing::Values(0, 1)),
                         [](const testing::TestParamInfo<std::tuple<MoveKind, int>>& info) {
                           return std::string(toString(std::get<0>(info.param))) +
                                  (std::get<1>(info.param) ? "_mid_pair" : "_pair_end");
                         });

class CancelIn : public testing::TestWithParam<S> {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(bringTo(rig_, GetParam()));
    before_ = rig_.log.size() - 1;
    ASSERT_TRUE(rig_.ask(E::kCancel).accepted);
    EXPECT_EQ(rig_.last().interlock, Interlock::kNone);
    for (int i = 0; i < 1000 && rig_.last().state == S::kCanceling; ++i) rig_.cycle();
  }

  Rig<FakeDrive> rig_;
  std::size_t before_ = 0;  ///< last sample before the request
};

TEST_P(CancelIn, EndsTheJobReadyAtRestAndTheWheelOffTheWork) {
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE(rig_.last().job_ended);
  const std::size_t ended = rig_.log.size() - 1;
  rig_.run(100);
  EXPECT_EQ(rig_.jobsEnded(), 1);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kNone);
  EXPECT_TRUE(atRestFrom(rig_.log, ended));
  EXPECT_TRUE(smooth(rig_.log));
  const Axes& before = rig_.log[before_].command;
  const Axes& now = rig_.last().command;
  EXPECT_GE(now[kY], kClearanceHeight - 1e-12);
  EXPECT_FALSE(rig_.last().wheel_in_work);
  if (GetParam() == S::kStarting || GetParam() == S::kRetracted) {
    EXPECT_TRUE(sameBits(now, before));
  } else if (GetParam() == S::kHeld) {
    EXPECT_TRUE(sameBits(now, Axes(before[kX], now[kY], before[kZ], before[kA])));
  }
}

INSTANTIATE_TEST_SUITE_P(, CancelIn,
                         testing::Values(S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracting,
                                         S::kRetracted, S::kResuming),
                         stateName);

}  // namespace test_cancel
}  // namespace grinder::test_support
