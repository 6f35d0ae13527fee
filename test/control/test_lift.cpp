#include "control/paper_job.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

// The wheel in the work: how it is detected, what is refused until the wheel is lifted, and the lift without a job.
namespace grinder::test_support {
namespace test_lift {

/// Turns Y by hand, without power.
void turnTo(Rig<FakeDrive>& rig, double y) {
  constexpr double kWay = 1e-3;
  double& at = rig.drive.position[kY];
  while (at != y) {
    at += std::clamp(y - at, -kWay, kWay);
    if (std::abs(at - y) < 1e-12) at = y;
    rig.cycle();
  }
}

TEST(InTheWork, LiftGoesStraightUpUntilItIsClear) {
  RigInTheWork rig;
  EXPECT_EQ(rig.askToStartPaper().text, "start refused: the wheel is in the work; lift it first");
  ASSERT_TRUE(rig.jog({kY, true, 0, 1e-3}).accepted) << "it has no end of its own, as the lift has";
  rig.runUntil(S::kReady);
  const std::size_t before = rig.log.size() - 1;
  const Axes from = rig.last().command;
  ASSERT_TRUE(rig.ask(E::kLift).accepted);
  EXPECT_EQ(rig.last().state, S::kLifting);
  const std::uint64_t written = rig.loop->status().setpoints_written;
  while (rig.last().state == S::kLifting) {
    const CycleSample& sample = rig.last();
    ASSERT_TRUE(sample.has_setpoint);
    ASSERT_EQ(sample.job, 0u);
    ASSERT_EQ(sample.setpoint.move, MoveKind::kLift);
    ASSERT_TRUE(sample.wheel_in_work);
    ASSERT_TRUE(sameBits(sample.command, Axes(from[kX], sample.command[kY], from[kZ], from[kA])));
    ASSERT_GE(sample.command[kY], rig.log[rig.log.size() - 2].command[kY]);
    ASSERT_FALSE(rig.drive.written_drive.spindle);
    ASSERT_NEAR(sample.distance_to_go[kY], rig.loop->status().wheel.clear_y - sample.position[kY], 1e-12);
    rig.cycle();
  }
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_EQ(rig.last().command[kY], rig.loop->status().wheel.clear_y);
  EXPECT_NEAR(rig.last().command[kY], kClearanceHeight, 1e-12);
  EXPECT_FALSE(rig.last().wheel_in_work);
  EXPECT_FALSE(rig.last().job_ended);
  EXPECT_EQ(rig.last().job, 1u) << "the last job's, where there is no setpoint";
  EXPECT_EQ(rig.loop->status().setpoints_written, written);
  EXPECT_EQ(rig.loop->status().jobs_started, 1u);
  EXPECT_TRUE(smooth({rig.log.begin() + static_cast<std::ptrdiff_t>(before), rig.log.end()}));
  EXPECT_EQ(rig.ask(E::kLift).text, "lift refused: the wheel is not in the work");
}

TEST(InTheWork, IsOverWhenTheAxisIsSeenAboveByADriveThatKnowsWhereItIs) {
  RigInTheWork rig;
  ASSERT_TRUE(rig.ask(E::kDisable).accepted);
  const auto seeAt = [&](double y, bool homed, int cycles) {
    rig.drive.status.homed = homed;
    turnTo(rig, y);
    return rig.run(cycles).wheel_in_work;
  };
  EXPECT_TRUE(seeAt(kClearanceHeight - 11e-6, true, 200));
  EXPECT_TRUE(seeAt(0.05, false, 200)) << "the position means nothing";
  EXPECT_TRUE(seeAt(kClearanceHeight - 1e-4, false, 1));
  rig.drive.on_read = [](FakeDrive& d) { --d.status.feedback_count; };
  EXPECT_TRUE(seeAt(0.05, true, 200)) << "the position is an old one";
  rig.drive.on_read = nullptr;
  EXPECT_TRUE(seeAt(kClearanceHeight - 1e-4, false, 1));
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(seeAt(kClearanceHeight + 1e-4, true, 10)) << "readings may be wrong";
    EXPECT_TRUE(seeAt(kClearanceHeight - 1e-4, true, 1));
  }
  EXPECT_FALSE(seeAt(0.05, true, 200));
  EXPECT_FALSE(seeAt(0, true, 200)) << "and nothing brings it back but a job";
}

// An axis that has been lifted rests some counts of its encoder below, and is clear with power as without.
TEST(WheelWatch, IsClearWhereALiftHasLeftIt) {
  for (const bool is_clear : {true, false}) {
    Wheel wheel;
    wheel.clear_y = kClearanceHeight;
    WheelWatch watch(wheel);
    watch.followJob(kClearanceHeight);
    watch.observePosition(kClearanceHeight - (is_clear ? 131e-9 : 11e-6), false, 1e-3);
    EXPECT_EQ(watch.wheel().in_work, !is_clear);
  }
}

/// How Y comes to be read a turn of its screw too high.
struct Jump {
  const char* name;
  std::function<void(Rig<FakeDrive>&)> happen;
};

const std::vector<Jump>& jumps() {
  constexpr double kTurn = 0.01;
  const auto in_one_cycle = [](Rig<FakeDrive>& rig, const std::function<void(FakeDrive&)>& reading) {
    rig.drive.on_read = reading;
    rig.cycle();
    rig.drive.on_read = nullptr;
  };
  static const std::vector<Jump> all{
      {"with power", [=](auto& rig) { in_one_cycle(rig, [](FakeDrive& d) { d.position[kY] += kTurn; }); }},
      {"with X, which comes first",
       [=](auto& rig) { in_one_cycle(rig, [](FakeDrive& d) { d.position[kX] += kTurn, d.position[kY] += kTurn; }); }},
      {"seen by the drive itself",
       [=](auto& rig) {
         in_one_cycle(rig, [](FakeDrive& d) { d.position[kY] += kTurn, d.status.emergency_stop = true; });
       }},
      {"without power",
       [=](auto& rig) {
         breakDown(rig);
         rig.run(50);
         rig.drive.position[kY] += kTurn;
       }},
      {"unseen",
       [=](auto& rig) {
         breakDown(rig);
         rig.drive.on_read = [](FakeDrive& d) { --d.status.feedback_count; };
         rig.run(500);
         rig.drive.on_read = nullptr;
         rig.drive.position[kY] += kTurn;
       }},
      {"after no number", [=](auto& rig) {
         in_one_cycle(rig, [](FakeDrive& d) { d.position[kY] = std::numeric_limits<double>::quiet_NaN(); });
         rig.drive.position[kY] = rig.log[rig.log.size() - 2].position[kY] + kTurn;
       }}};
  return all;
}

TEST(YThatWasReadWhereItCannotBe, LeavesTheLiftAloneAndThenHoming) {
  for (const MoveKind move : {MoveKind::kStroke, MoveKind::kApproach}) {
    for (const Jump& jump : jumps()) {
      SCOPED_TRACE(std::string(jump.name) + " in " + toString(move));
      Rig<FakeDrive> rig;
      rig.startPaper();
      ASSERT_NO_FATAL_FAILURE(rig.runTo(move));
      rig.run(10);
      jump.happen(rig);
      rig.run(500);
      rig.drive.status.emergency_stop = false;
      EXPECT_TRUE(rig.last().wheel_in_work);
      EXPECT_FALSE(rig.last().drive.homed);
      ASSERT_NO_FATAL_FAILURE(rig.recover());
      rig.run(200);
      EXPECT_EQ(rig.ask(E::kSpindleOn).text, "spindle on refused: the wheel is in the work; lift it first");
      EXPECT_EQ(rig.ask(E::kHome).text, "home refused: the wheel is in the work; lift it first");
      for (const int axis : {kX, kY}) {
        EXPECT_EQ(rig.jog({axis, false, 1e-3, 0.01}).text, "jog refused: the axes are not homed");
      }
      const double from = rig.last().command[kY];
      ASSERT_NO_FATAL_FAILURE(rig.lift());
      EXPECT_NEAR(rig.last().command[kY] - from, kLift, 1e-15);
      EXPECT_FALSE(rig.run(200).wheel_in_work);
      EXPECT_EQ(rig.askToStartPaper().text, "start refused: the axes are not homed");
      ASSERT_TRUE(rig.ask(E::kHome).accepted);
      rig.run(3);
      rig.drive.on_read = [](FakeDrive& d) { d.status.homing = false, d.position[kY] = 0.05; };
      rig.run(2);
      rig.drive.on_read = nullptr;
      EXPECT_TRUE(rig.cycle().drive.homed);
      EXPECT_TRUE(rig.askToStartPaper().accepted);
    }
  }
}

TEST(YThatWasReadWhereItCannotBe, IsBelievedOnceLiftedWhereTheDriveDoesNotHome) {
  Rig<FakeDrive> rig(machineConfig(), [](FakeDrive& d) {
    d.place(machineConfig().machine.park);
    d.can.homing = false;
  });
  rig.startPaper();
  ASSERT_NO_FATAL_FAILURE(rig.runTo(MoveKind::kStroke));
  jumps().front().happen(rig);
  EXPECT_TRUE(rig.run(500).wheel_in_work);
  ASSERT_NO_FATAL_FAILURE(rig.recover());
  EXPECT_FALSE(rig.last().drive.homed);
  ASSERT_NO_FATAL_FAILURE(rig.lift());
  EXPECT_TRUE(rig.cycle().drive.homed);
  EXPECT_FALSE(rig.last().wheel_in_work);
}

TEST(AfterARestart, AWheelOfWhichNothingIsKnownIsMovedUpAloneToTheTop) {
  Rig<FakeDrive> rig(machineConfig(), unknownWheel(machineConfig().machine.limits, false));
  rig.enable();
  rig.run(500);
  const std::string refused = " refused: it is not known whether the wheel is in the work; lift it first";
  EXPECT_EQ(rig.askToStartPaper().text, "start" + refused);
  for (const E event : {E::kHome, E::kSpindleOn, E::kCoolantOn}) {
    EXPECT_EQ(rig.ask(event).text, toString(event) + refused);
  }
  for (const auto& [axis, way] : {std::pair(kX, 1e-3), std::pair(kX, -1e-3), std::pair(kY, -1e-3)}) {
    EXPECT_EQ(rig.jog({axis, false, way, 0.01}).text, "jog" + refused);
  }
  EXPECT_TRUE(rig.jog({kY, false, 1e-3, 0.01}).accepted);
  rig.runUntil(S::kReady);
  EXPECT_TRUE(rig.last().wheel_in_work);
  ASSERT_NO_FATAL_FAILURE(rig.lift());
  EXPECT_TRUE(rig.loop->status().wheel.known);
  EXPECT_TRUE(rig.ask(E::kHome).accepted);
}

TEST(AfterARestart, AWheelOfWhichNothingIsKnownIsLiftedToTheTopAndACupIsFirstBackedOffToTheEndOfX) {
  const AxisLimits limits = machineConfig().machine.limits;
  const double end = limits.min_position[kX], before_end = end - 1e-3;
  const struct {
    bool is_cup, homed;
    double x, x_of_lift;
  } rows[]{{false, false, 0, 0}, {true, true, 0, end}, {true, false, 0, end}, {true, false, before_end, before_end}};
  for (const auto& row : rows) {
    SCOPED_TRACE(testing::Message() << row.is_cup << row.homed << row.x);
    Rig<FakeDrive> rig(machineConfig(), unknownWheel(limits, row.is_cup));
    rig.drive.status.homed = row.homed;
    rig.drive.position = {row.x, 0.05, 0, 0};
    rig.enable();
    rig.run(500);
    EXPECT_EQ(rig.last().drive.homed, row.homed);
    EXPECT_EQ(rig.last().wheel_backs_off, row.x > row.x_of_lift);
    rig.keepLast();
    ASSERT_NO_FATAL_FAILURE(rig.lift());
    for (const CycleSample& sample : rig.log) {
      ASSERT_TRUE(sample.command[kX] == row.x_of_lift || sample.command[kY] == 0.05);
    }
    EXPECT_TRUE(sameBits(rig.last().command, Axes(row.x_of_lift, limits.max_position[kY], 0, 0)));
    EXPECT_FALSE(rig.last().wheel_in_work);
    EXPECT_FALSE(rig.last().wheel_backs_off);
  }
}

TEST(AfterARestart, WithoutTheReferenceItIsLiftedByTheDepthOfTheJobAndAnewOnceThePowerWasOff) {
  for (const bool was_off : {false, true}) {
    Rig<FakeDrive> rig(machineConfig(), Wheel{true, kClearanceHeight, kLift});
    rig.drive.status.homed = false;
    rig.drive.position[kY] = 0;
    rig.enable();
    double from = rig.last().command[kY];
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(rig.ask(E::kLift).accepted);
      for (const double y = rig.last().command[kY]; rig.last().command[kY] < y + 1e-3;) rig.cycle();
      ASSERT_TRUE(rig.ask(E::kHold).accepted);
      rig.runUntil(S::kReady);
      EXPECT_TRUE(rig.last().wheel_in_work);
    }
    if (was_off) {
      ASSERT_TRUE(rig.ask(E::kDisable).accepted);
      rig.enable();
      from = rig.last().command[kY];
    }
    ASSERT_NO_FATAL_FAILURE(rig.lift());
    EXPECT_NEAR(rig.last().command[kY] - from, kLift, 1e-15);
    EXPECT_FALSE(rig.last().wheel_in_work);
    EXPECT_TRUE(rig.ask(E::kHome).accepted);
  }
}

/// A wheel whose rim is round the work, as the journal knows it: 4 mm of X from where it may be lifted.
class RoundTheWork {
 public:
  static constexpr double kClearX = 0.002, kBack = 0.005, kHeight = 0.011;

  explicit RoundTheWork(bool homed, double back = kBack, bool y_doubted = false)
      : rig(machineConfig(), Wheel{true, kClearanceHeight, kHeight, y_doubted, true, kClearX, back}) {
    rig.drive.status.homed = homed;
    rig.drive.position = {kClearX + 0.004, -0.008, 0, 0};
    rig.enable();
    from = rig.last().command;
  }

  /// Runs until the lift ends, and expects that it went along X, and then along Y.
  void expectLifted(double x, double y) {
    rig.keepLast();
    ASSERT_NO_FATAL_FAILURE(rig.lift());
    for (const CycleSample& sample : rig.log) {
      const Axes& at = sample.command;
      ASSERT_TRUE(at[kY] == from[kY] || at[kX] == x) << at.transpose();
      ASSERT_TRUE(sameBits(at, Axes(at[kX], at[kY], from[kZ], from[kA])));
    }
    EXPECT_TRUE(sameBits(rig.last().command, Axes(x, y, from[kZ], from[kA]))) << rig.last().command.transpose();
    EXPECT_FALSE(rig.last().wheel_in_work);
    EXPECT_TRUE(smooth(rig.log));
  }

  Rig<FakeDrive> rig;
  Axes from;
};

TEST(AWheelRoundTheWork, IsMovedByHandOnlyAsALiftMovesIt) {
  RoundTheWork wheel(true);
  auto& rig = wheel.rig;
  const auto move = [&](int axis, double way) {
    const RequestReply reply = rig.jog({axis, false, way, 0.01});
    if (reply.accepted) rig.runUntil(S::kReady);
    return reply.text;
  };
  const std::string refused = "jog refused: the wheel is in the work; lift it first";
  for (const auto& [axis, way] : {std::pair(kX, 1e-3), std::pair(kY, 1e-3), std::pair(kY, -1e-3)}) {
    EXPECT_EQ(move(axis, way), refused);
  }
  EXPECT_EQ(move(kX, -4e-3), "");
  EXPECT_EQ(move(kX, -1e-3), refused) << "it has backed off";
  EXPECT_EQ(move(kY, 1e-3), "");
  wheel.from = rig.last().command;
  wheel.expectLifted(RoundTheWork::kClearX, kClearanceHeight);
  EXPECT_EQ(move(kX, 0.01), "");
  EXPECT_FALSE(rig.last().wheel_backs_off) << "it is not in the work";
}

TEST(AWheelRoundTheWork, WhoseYIsDoubtedBacksOffToWhereXIsClear) {
  RoundTheWork wheel(true, RoundTheWork::kBack, true);
  wheel.expectLifted(RoundTheWork::kClearX, wheel.from[kY] + RoundTheWork::kHeight);
}

TEST(AWheelRoundTheWork, IsLiftedToWhereItWasToGoAlsoIfTheReferenceIsLostMeanwhile) {
  RoundTheWork wheel(true);
  auto& rig = wheel.rig;
  ASSERT_TRUE(rig.ask(E::kLift).accepted);
  rig.run(5);
  rig.drive.status.homed = false;
  rig.runUntil(S::kReady);
  EXPECT_EQ(rig.last().command[kX], RoundTheWork::kClearX);
  EXPECT_EQ(rig.last().command[kY], kClearanceHeight);
}

TEST(AWheelRoundTheWork, IsNotLiftedOnceAStopCameWhileItBackedOff) {
  for (const double stopped_after : {0.2e-3, 2e-3}) {  // the second comes to rest where it would have anyway
    for (const bool homed : {true, false}) {
      for (const E stop : {E::kHold, E::kCancel, E::kDisable}) {
        RoundTheWork wheel(homed);
        auto& rig = wheel.rig;
        const double x = homed ? RoundTheWork::kClearX : wheel.from[kX] - RoundTheWork::kBack;
        ASSERT_TRUE(rig.ask(E::kLift).accepted);
        while (rig.last().command[kX] > wheel.from[kX] - stopped_after) rig.cycle();
        ASSERT_TRUE(rig.ask(stop).accepted);
        rig.runUntil(stop == E::kDisable ? S::kDisabled : S::kReady);
        EXPECT_EQ(rig.last().command[kX] > x, stopped_after < 1e-3);
        EXPECT_EQ(rig.last().command[kY], wheel.from[kY]);
        EXPECT_TRUE(rig.last().wheel_in_work);
        if (stop == E::kDisable) continue;
        wheel.expectLifted(x, homed ? kClearanceHeight : wheel.from[kY] + RoundTheWork::kHeight);
      }
    }
  }
}

TEST(AWheelRoundTheWork, IsNotBackedOffBeyondTheAxis) {
  const double lowest = machineConfig().machine.limits.min_position[kX];
  RoundTheWork wheel(false, RoundTheWork::kClearX + 0.004 - lowest + 1e-3);
  EXPECT_EQ(wheel.rig.ask(E::kLift).text,
            "lift refused: it would lead axis X to machine position -101 mm; allowed: down to -100 mm");
}

TEST(AfterARestart, ItIsLiftedFromBeyondTheLimitsOfTheOtherAxes) {
  Rig<FakeDrive> rig(machineConfig(), Wheel{true, kClearanceHeight, kLift});
  const AxisLimits& limits = machineConfig().machine.limits;
  rig.drive.position = {limits.max_position[kX] + 1e-6, -0.0005, limits.min_position[kZ] - 0.1, 0};
  rig.enable();
  const Axes from = rig.last().command;
  const std::size_t before = rig.log.size() - 1;
  ASSERT_NO_FATAL_FAILURE(rig.lift());
  EXPECT_TRUE(sameBits(rig.last().command, Axes(from[kX], kClearanceHeight, from[kZ], from[kA])));
  EXPECT_TRUE(smooth({rig.log.begin() + static_cast<std::ptrdiff_t>(before), rig.log.end()}));
  EXPECT_CONTAINS(rig.jog({kY, false, 1e-3, 0.01}).text, "outside its limit");
}

TEST(AfterARestart, ALiftBeyondTheAxisIsRefused) {
  const auto expect_refused = [](const Wheel& wheel, double y, const char* to) {
    Rig<FakeDrive> rig(machineConfig(), wheel);
    rig.drive.status.homed = wheel.known;
    rig.drive.position[kY] = y;
    rig.enable();
    EXPECT_EQ(rig.ask(E::kLift).text, std::string("lift refused: it would lead axis Y to machine position ") + to +
                                          " mm; allowed: up to 150 mm");
    EXPECT_EQ(rig.last().state, S::kReady);
  };
  expect_refused({true, 0.2, 0.01}, 0, "200");
  expect_refused({true, std::numeric_limits<double>::quiet_NaN(), 0.01}, 0, "nan");
  expect_refused(unknownWheel(machineConfig().machine.limits, false), 0.151, "321");  // by its whole travel
  EXPECT_DOUBLE_EQ(unknownWheel(machineConfig().machine.limits, true).back, 0.4);     // also of X
}

TEST(YThatWasReadWhereItCannotBe, IsNotBelievedAfterARestart) {
  Rig<FakeDrive> rig(machineConfig(), Wheel{true, kClearanceHeight, kLift, true});
  EXPECT_TRUE(rig.run(500).wheel_in_work);
  EXPECT_FALSE(rig.last().drive.homed);
  EXPECT_TRUE(rig.loop->status().wheel.y_doubted);
}

}  // namespace test_lift
}  // namespace grinder::test_support
