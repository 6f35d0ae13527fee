#include "control/checks.h"
#include "control/rig.h"

#include <algorithm>
#include <functional>
#include <string>

// Homing: the drive finds the machine's reference by itself while the loop only monitors it.
namespace grinder::test_support {
namespace test_homing {

class HomingFake : public testing::Test {
 protected:
  void SetUp() override { rig_.enable(); }

  /// Changes what the drive reports while it is commanded to home.
  /// @param change gets the number of the reading, from 1.
  void changeHoming(const std::function<void(FakeDrive&, int)>& change) {
    rig_.drive.on_read = [=, reading = 0](FakeDrive& d) mutable {
      if (d.written_drive.home) change(d, ++reading);
    };
  }

  void expectFaultFor(const std::string& time) {
    ASSERT_EQ(rig_.last().state, S::kFault);
    EXPECT_EQ(rig_.last().fault.kind, FaultKind::kHoming);
    EXPECT_EQ(rig_.last().fault.text(), "the drive has not found its reference after " + time + " s, allowed 0.0505 s");
    EXPECT_FALSE(rig_.drive.written_drive.home);
    EXPECT_FALSE(rig_.drive.written_drive.enable);
  }

  Rig<FakeDrive> rig_;
};

TEST_F(HomingFake, CommandsFollowThePositionsHoweverTheyJump) {
  changeHoming([](FakeDrive& d, int reading) {
    d.status.homing = reading <= 10;
    const int place = std::min(reading, 11);
    d.place({0.1 * place, -0.01 * place, 0.02 * place, -3.0 * place});
  });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  // The last jump may be the new reference, or a wrong reading: the one after it shows that.
  for (int i = 0; i < 12; ++i) {
    rig_.cycle();
    ASSERT_TRUE(sameBits(toAxes(rig_.drive.written), toAxes(rig_.drive.position))) << "cycle " << i;
  }
  EXPECT_EQ(rig_.last().state, S::kReady);
  const Axes homed = toAxes(rig_.drive.position);
  rig_.run(50);
  EXPECT_EQ(rig_.last().state, S::kReady);
  EXPECT_TRUE(sameBits(toAxes(rig_.drive.written), homed));
  // From then on they do not.
  rig_.drive.on_read = [](FakeDrive& d) { d.position[kX] += 0.0011; };
  EXPECT_EQ(rig_.cycle().fault.kind, FaultKind::kFollowingError);
}

TEST_F(HomingFake, IsNotDoneByAReadingThatTheNextOneBeliesAndNothingJumps) {
  const Axes home = machineConfig().machine.park;
  // With the reference, after the tenth, the readings may jump once: a second time, one of the two is wrong.
  for (const int wrong : {10, 12, 11}) {
    SCOPED_TRACE(wrong);
    changeHoming([=](FakeDrive& d, int reading) {
      d.status.homing = reading <= 10;
      d.place(home);
      if (reading == wrong) d.position[kZ] += 0.01;
    });
    ASSERT_TRUE(rig_.ask(E::kHome).accepted);
    for (int i = 0; i < 20; ++i) {
      rig_.cycle();
      const bool follows = rig_.drive.written_drive.enable && !rig_.drive.written_drive.home;
      ASSERT_TRUE(!follows || sameBits(toAxes(rig_.drive.written), home)) << i;
    }
    EXPECT_EQ(rig_.last().state, wrong == 11 ? S::kFault : S::kReady) << rig_.last().fault.text();
    EXPECT_EQ(rig_.last().drive.homed, wrong != 11);
  }
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kHoming);
}

/// What was read before says nothing of the reference: it neither ends the homing nor excuses a second jump.
TEST_F(HomingFake, EndsByNewReadingsOnly) {
  Axes there = machineConfig().machine.park;
  for (const bool jumps_again : {false, true}) {
    SCOPED_TRACE(jumps_again);
    changeHoming([=](FakeDrive& d, int reading) {
      d.status.homing = reading <= 10;
      if (reading == 11 || reading == 13) --d.status.feedback_count;
      d.place(there);
      if (reading >= 12) d.position[kZ] += 0.01;
      if (reading >= 14 && jumps_again) d.position[kZ] += 0.01;
    });
    ASSERT_TRUE(rig_.ask(E::kHome).accepted);
    rig_.run(20);
    EXPECT_EQ(rig_.last().state, jumps_again ? S::kFault : S::kReady) << rig_.last().fault.text();
    there[kZ] += 0.01;
  }
  EXPECT_EQ(rig_.last().fault.kind, FaultKind::kHoming);
}

/// A jump of Y is doubted against a reading that had the reference: not after one in homing, without it, or before all.
TEST(Homing, LeavesNothingByWhichYIsDoubted) {
  for (const S state : {S::kHoming, S::kDisabled}) {
    SCOPED_TRACE(toString(state));
    RigIn rig(state);
    rig.loop->postStop(E::kDisable);
    rig.drive.status.homed = state == S::kHoming;
    rig.drive.position[kY] += 0.01;
    ASSERT_EQ(rig.cycle().state, S::kDisabled);
    rig.drive.status.homed = true;
    rig.drive.position[kY] += 0.01;
    EXPECT_TRUE(rig.cycle().drive.homed);
    rig.drive.position[kY] += 0.01;
    EXPECT_FALSE(rig.cycle().drive.homed);
  }
  Rig<FakeDrive> rig;
  rig.drive.on_read = [](FakeDrive& d) { d.status.feedback_count = 0, d.position = {}; };
  rig.run(3);
  rig.drive.on_read = nullptr;
  rig.drive.place(machineConfig().machine.park);
  EXPECT_TRUE(rig.cycle().drive.homed);
}

TEST_F(HomingFake, ThatNeverEndsOrNeverBeginsFaultsAfterTheTimeout) {
  for (const bool begins : {true, false}) {
    SCOPED_TRACE(begins);
    // Throughout it reports that it is homed, as before.
    changeHoming([=](FakeDrive& d, int) { d.status.homing = begins; });
    ASSERT_TRUE(rig_.ask(E::kHome).accepted);
    // 50.5 periods, and the cycle of the request counts.
    for (int i = 2; i <= 50; ++i) ASSERT_EQ(rig_.cycle().state, S::kHoming) << "in cycle " << i;
    rig_.cycle();
    expectFaultFor("0.051");
    ASSERT_NO_FATAL_FAILURE(rig_.recover());
  }
}

TEST_F(HomingFake, ThatEndsWithoutTheReferenceFaultsAtOnce) {
  changeHoming([](FakeDrive& d, int reading) {
    d.status.homing = reading <= 6;
    d.status.homed = false;
  });
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  for (int i = 0; i < 6; ++i) ASSERT_EQ(rig_.cycle().state, S::kHoming);
  rig_.cycle();
  expectFaultFor("0.008");
}

TEST_F(HomingFake, ThatOfBeforeDoesNotEndIt) {
  bool homing = true;
  rig_.drive.on_read = [&](FakeDrive& d) { d.status.homing = homing; };
  rig_.cycle();
  ASSERT_TRUE(rig_.ask(E::kHome).accepted);
  const auto expect_after = [&](bool reported, S state) {
    homing = reported;
    EXPECT_EQ(rig_.cycle().state, state);
  };
  expect_after(true, S::kHoming);
  expect_after(false, S::kHoming);
  expect_after(true, S::kHoming);
  expect_after(false, S::kReady);
}

}  // namespace test_homing
}  // namespace grinder::test_support
