#include "control/paper_job.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

// Jogs: steps and continuous ones, what is refused, and how they end.
namespace grinder::test_support {
namespace test_jog {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kTimeoutCycles = 50;  // of 50.5 ms

JogRequest step(int axis, double distance, double speed = 0.02) { return {axis, false, distance, speed}; }
JogRequest on(int axis, double velocity) { return {axis, true, 0, velocity}; }
void release(Rig<FakeDrive>& rig) { EXPECT_TRUE(rig.jog(on(kX, 0)).accepted); }

constexpr const char* kStoppedText = "jog refused: it was stopped or refused before; release the button first";
constexpr const char* kTimedOutText = "jog refused: it was not repeated within jog_timeout; release the button first";

/// Distance in which the machine of the tests stops an axis: half the speed times the time of a stop, v/a + a/j where
/// the full deceleration is reached, else 2 sqrt(v/j).
double brakingDistance(int axis, double v) {
  const AxisLimits limits = machineConfig().machine.limits;
  const double a = limits.max_acceleration[axis], j = limits.max_jerk[axis];
  return v / 2 * (v >= a * a / j ? v / a + a / j : 2 * std::sqrt(v / j));
}

class JogFrom : public testing::TestWithParam<S> {
 protected:
  void SetUp() override {
    rig_.run(5);
    before_ = rig_.log.size() - 1;
    at_ = rig_.last().command;
  }
  S jogging() const { return GetParam() == S::kReady ? S::kJogging : S::kJoggingRetracted; }
  /// Refreshes a continuous jog for some cycles, every 20th.
  void jogFor(const JogRequest& request, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      if (i % 20 == 0) {
        ASSERT_TRUE(rig_.jog(request).accepted);
      } else {
        rig_.cycle();
      }
    }
  }
  /// Repeats a message every 20th cycle, and expects that each is refused and that nothing moves.
  void expectRefused(const JogRequest& request, const std::string& text) {
    const std::size_t begin = rig_.log.size() - 1;
    for (int i = 0; i < 1000; ++i) {
      if (i % 20 == 0) {
        ASSERT_EQ(rig_.jog(request).text, text);
      }
      rig_.cycle();
    }
    EXPECT_TRUE(atRestFrom(rig_.log, begin));
    EXPECT_EQ(rig_.last().state, GetParam());
  }
  /// Expects that X, jogged at 0.1 m/s, comes to rest within the distance that it takes.
  void expectStop() {
    const double from = rig_.last().command[kX];
    rig_.runUntil(GetParam());
    EXPECT_LE(rig_.last().command[kX] - from, brakingDistance(kX, 0.1) + 0.1 * 0.003);
    EXPECT_TRUE(smooth(rig_.log));
  }
  RigIn rig_{GetParam()};
  std::size_t before_ = 0;
  Axes at_ = Axes::Zero();
};

TEST_P(JogFrom, AStepMovesItsAxisExactlyByItsDistanceAndComesBackToTheState) {
  for (const auto& [axis, distance] : std::vector<std::pair<int, double>>{
           {kX, 0.01}, {kX, -0.012}, {kY, 0.005}, {kY, -0.004}, {kZ, 1e-6}, {kZ, -0.01}, {kA, 2}, {kA, -0.01}}) {
    const Axes from = rig_.last().command;
    const std::uint64_t written = rig_.loop->status().setpoints_written;
    const RequestReply answer = rig_.jog(step(axis, distance));
    ASSERT_TRUE(answer.accepted) << answer.text;
    EXPECT_EQ(rig_.last().state, jogging());
    while (rig_.last().state == jogging()) {
      Axes expected = from;
      expected[axis] = rig_.last().command[axis];
      ASSERT_TRUE(sameBits(rig_.last().command, expected));
      ASSERT_EQ(rig_.last().job,
                rig_.last().has_setpoint && GetParam() == S::kReady ? 0u : rig_.loop->status().jobs_started);
      rig_.cycle();
    }
    EXPECT_EQ(rig_.last().state, GetParam());
    EXPECT_EQ(rig_.last().command[axis], from[axis] + distance);
    const std::uint64_t by_now = rig_.loop->status().setpoints_written;
    EXPECT_TRUE(GetParam() == S::kReady ? by_now == written : by_now > written) << "a job samples its jogs";
  }
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(JogFrom, AStepBeyondALimitIsRefusedWithTheLimit) {
  const struct {
    JogRequest jog;
    const char* text;
  } cases[]{
      {step(kX, 0.4), "; allowed: up to 300 mm"},      {step(kX, -0.2), "; allowed: down to -100 mm"},
      {step(kY, 0.2), "; allowed: up to 150 mm"},      {step(kZ, 0.2), "; allowed: up to 100 mm"},
      {step(kA, 1000), "; allowed: up to 7200 deg"},   {step(kX, kNan), "; allowed: up to 300 mm"},
      {step(kX, HUGE_VAL), "; allowed: up to 300 mm"},
  };
  for (const auto& c : cases) {
    const RequestReply answer = rig_.jog(c.jog);
    EXPECT_FALSE(answer.accepted);
    EXPECT_CONTAINS(answer.text, "jog refused: it would lead axis ");
    EXPECT_CONTAINS(answer.text, c.text);
  }
  rig_.run(10);
  EXPECT_TRUE(atRestFrom(rig_.log, before_));
  EXPECT_EQ(rig_.last().state, GetParam());
  EXPECT_TRUE(rig_.jog(on(kX, 0.01)).accepted) << "a refused step is no button that was pressed";
}

TEST_P(JogFrom, SpeedAndAxisAreChecked) {
  EXPECT_EQ(rig_.jog(step(kX, 0.01, 0.21)).text,
            "jog refused: speed of axis X = 12600 mm/min; allowed: above 0, up to 12000 mm/min");
  EXPECT_CONTAINS(rig_.jog(step(kA, 0.01, 13)).text, "speed of axis A = 744.845 deg/s; allowed: above 0, up to ");
  for (const double speed : {0.0, -0.01, kNan}) {
    EXPECT_CONTAINS(rig_.jog(step(kX, 0.01, speed)).text, "speed of axis X = ");
  }
  EXPECT_CONTAINS(rig_.jog(on(kX, -0.21)).text, "speed of axis X = 12600 mm/min");
  for (const int axis : {-1, 4, 255}) {
    EXPECT_EQ(rig_.jog(step(axis, 0.01)).text,
              "jog refused: axis = " + std::to_string(axis) + "; allowed: 0 to 3 for X, Y, Z, A");
  }
  EXPECT_TRUE(atRestFrom(rig_.log, before_));
}

TEST_P(JogFrom, WithoutMessagesTheAxisRestsWithinTheBrakingDistance) {
  for (const auto& [axis, velocity] :
       std::vector<std::pair<int, double>>{{kX, 0.2}, {kX, -0.1}, {kY, 0.05}, {kZ, -0.003}, {kA, 10}}) {
    jogFor(on(axis, velocity), 600);
    ASSERT_TRUE(rig_.jog(on(axis, velocity)).accepted);
    const double last = rig_.last().command[axis];
    const S during = rig_.last().state;
    EXPECT_EQ(during, jogging());
    const std::size_t message = rig_.log.size() - 1;
    rig_.runUntil(GetParam());
    // The time-out, the cycle in which it is seen, and the pair that was begun.
    const double speed = std::abs(velocity);
    const double farthest = speed * 0.001 * (kTimeoutCycles + 3) + brakingDistance(axis, speed);
    const double way = std::abs(rig_.last().command[axis] - last);
    EXPECT_LE(way, farthest * (1 + 1e-6));
    EXPECT_GE(way, speed * 0.001 * kTimeoutCycles);
    for (int i = 0; i < kTimeoutCycles; ++i) {
      const double moved = rig_.log[message + i + 1].command[axis] - rig_.log[message + i].command[axis];
      ASSERT_NEAR(moved, velocity * 0.001, 1e-9) << "it stopped before the time-out, in cycle " << i;
    }
    release(rig_);
  }
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(JogFrom, VelocityZeroANumberThatIsNoneOrALostReferenceStopsIt) {
  const std::function<void()> stops[]{[&] { EXPECT_TRUE(rig_.jog(on(kX, 0)).accepted); },
                                      [&] { EXPECT_FALSE(rig_.jog(on(kX, kNan)).accepted); },
                                      [&] { rig_.drive.status.homed = false; }};
  for (const auto& stop : stops) {
    jogFor(on(kX, 0.1), 400);
    stop();
    expectStop();
    rig_.drive.status.homed = true;
    release(rig_);
  }
}

TEST_P(JogFrom, AfterATimeoutOrAHoldOnlyAReleaseLetsItMoveAgain) {
  for (const bool held : {false, true}) {
    const char* text = held ? kStoppedText : kTimedOutText;
    jogFor(on(kX, 0.1), 400);
    if (held) {
      ASSERT_TRUE(rig_.ask(E::kHold).accepted);
    } else {
      rig_.run(kTimeoutCycles + 1);
    }
    ASSERT_EQ(rig_.last().state, jogging()) << "it still decelerates";
    // What is stopped is not taken up again, and a longer silence changes nothing.
    EXPECT_EQ(rig_.jog(on(kX, 0.1)).text, text);
    expectStop();
    expectRefused(on(kX, 0.1), text);
    rig_.run(20 * kTimeoutCycles);
    expectRefused(on(kZ, 0.01), text);
    // A step needs no button.
    ASSERT_TRUE(rig_.jog(step(kZ, 0.001)).accepted);
    rig_.runUntil(GetParam());
    expectRefused(on(kX, 0.1), text);
    release(rig_);
    jogFor(on(kX, 0.1), 10);
    EXPECT_EQ(rig_.last().state, jogging());
  }
}

TEST_P(JogFrom, TheLastMessageCounts) {
  jogFor(on(kX, 0.1), 400);
  jogFor(on(kX, 0.02), 400);
  const std::size_t slow = rig_.log.size() - 1;
  EXPECT_NEAR(rig_.log[slow].command[kX] - rig_.log[slow - 1].command[kX], 0.02e-3, 1e-10);
  jogFor(on(kX, -0.05), 600);
  EXPECT_EQ(rig_.last().state, jogging());
  const std::size_t back = rig_.log.size() - 1;
  EXPECT_NEAR(rig_.log[back].command[kX] - rig_.log[back - 1].command[kX], -0.05e-3, 1e-10);
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(JogFrom, AnotherAxisOrStepIsRefusedUntilTheOneRests) {
  const auto expect_refused = [&](std::initializer_list<JogRequest> others) {
    for (const JogRequest& other : others) {
      EXPECT_EQ(rig_.jog(other).text, "jog refused: an axis is being jogged; wait until it rests");
    }
  };
  jogFor(on(kX, 0.1), 100);
  expect_refused({on(kZ, 0.01), step(kX, 0.001), step(kZ, 0.001)});
  EXPECT_FALSE(rig_.jog(step(9, 0.001)).accepted);
  EXPECT_TRUE(rig_.jog(on(kX, 0.1)).accepted) << "which the others do not stop";
  release(rig_);
  expect_refused({on(kZ, 0.01), step(kZ, 0.001)});
  expectStop();
  release(rig_);
  ASSERT_TRUE(rig_.jog(step(kX, 0.01)).accepted);
  expect_refused({on(kX, 0.1)});
  release(rig_);
  rig_.runUntil(GetParam());
  EXPECT_EQ(rig_.last().command[kZ], at_[kZ]);
  jogFor(on(kZ, 0.01), 10);
  EXPECT_EQ(rig_.last().state, jogging());
}

INSTANTIATE_TEST_SUITE_P(, JogFrom, testing::Values(S::kReady, S::kRetracted), stateName);

TEST(Jog, FromOutsideTheLimitsOfAnyAxisIsRefused) {
  const std::tuple<int, double, const char*> rows[]{
      {kX, -0.101, "axis X is at machine position -101 mm, outside its limit -100 mm"},
      {kY, 0.151, "axis Y is at machine position 151 mm, outside its limit 150 mm"},
      {kZ, -0.051, "axis Z is at machine position -51 mm, outside its limit -50 mm"},
      {kA, 130, "axis A is at machine position 7448.45 deg, outside its limit 7200 deg"}};
  for (const auto& [axis, at, text] : rows) {
    Rig<FakeDrive> rig;
    rig.drive.position[static_cast<std::size_t>(axis)] = at;
    rig.enable();
    EXPECT_EQ(rig.jog(step(kX, 0.001)).text, std::string("jog refused: ") + text);
  }
}

/// A client may round a distance to a limit by a unit in its last place, and no more.
TEST(Jog, ByAStepThatOnlyRoundingLeadsBeyondALimitEndsThere) {
  RigIn rig(S::kReady);
  ASSERT_EQ(rig.last().command[kZ], 0);
  const double limit = machineConfig().machine.limits.max_position[kZ], rounded = std::nextafter(limit, 1);
  EXPECT_FALSE(rig.jog(step(kZ, std::nextafter(rounded, 1))).accepted);
  ASSERT_TRUE(rig.jog(step(kZ, rounded)).accepted);
  rig.runUntil(S::kReady);
  EXPECT_EQ(rig.last().command[kZ], limit);
}

TEST(Jog, OnADriveWithABufferItIsOverWhenTheAxisRests) {
  RigIn rig(S::kReady, machineConfig(), 4);
  rig.drive.status.commands_waiting = 4;
  const double from = rig.last().command[kX];
  ASSERT_TRUE(rig.jog(step(kX, 1e-5)).accepted);
  std::size_t reached = 0;
  while (rig.last().state == S::kJogging) {
    rig.cycle();
    if (reached == 0 && rig.last().command[kX] == from + 1e-5) reached = rig.log.size() - 1;
  }
  EXPECT_GE(rig.log.size() - 1 - reached, 4u);
}

/// A stall of the host is a late cycle and starts the count of a silence anew, but only once.
TEST(Jog, AStallIsForgivenOncePerMessage) {
  LoopConfig config = machineConfig();
  config.feedback_timeout = 1;
  constexpr double kSpeed = 0.002;
  for (const bool for_client : {false, true}) {
    SCOPED_TRACE(for_client);
    RigIn rig(S::kReady, config, 1);
    rig.drive.status.commands_waiting = 1;  // so that the axis goes on in a stall
    JogRequest jog = for_client ? step(kX, 0.05, kSpeed) : on(kX, kSpeed);
    jog.for_client = for_client;
    rig.loop->keepAlive();
    ASSERT_TRUE(rig.jog(jog).accepted);
    rig.run(40);
    rig.cycle(21);
    rig.run(40);  // 42 ms of silence
    EXPECT_NEAR(rig.last().setpoint.velocity[kX], kSpeed, 1e-9);
    rig.cycle(52);
    rig.run(6);  // 50 ms
    EXPECT_NEAR(rig.last().setpoint.velocity[kX], kSpeed, 1e-9);
    rig.run(10);
    EXPECT_LT(rig.last().setpoint.velocity[kX], 0.9 * kSpeed);
  }
}

TEST(JogInTheWork, OnlyUpwardsIsAllowed) {
  RigInTheWork rig;
  for (const JogRequest& jog : {step(kX, 0.001), step(kX, -0.001), step(kY, -0.0001), step(kZ, 0.001), step(kA, 0.01),
                                on(kX, 0.01), on(kY, -0.01)}) {
    EXPECT_EQ(rig.jog(jog).text, "jog refused: the wheel is in the work; lift it first");
    release(rig);
  }
  ASSERT_TRUE(rig.jog(step(kY, 0.001)).accepted);
  rig.runUntil(S::kReady);
  EXPECT_TRUE(rig.last().wheel_in_work);
  ASSERT_TRUE(rig.jog(step(kY, 0.02)).accepted);
  rig.runUntil(S::kReady);
  EXPECT_FALSE(rig.last().wheel_in_work) << "it is clear by now";
  EXPECT_TRUE(rig.jog(step(kX, 0.001)).accepted);
}

TEST(JogRetracted, NeverGoesDownToTheWork) {
  RigIn rig(S::kRetracted);
  const double clear = rig.loop->status().wheel.clear_y;
  EXPECT_NEAR(clear, kClearanceHeight, 1e-12);
  EXPECT_EQ(rig.jog(on(kY, -0.01)).text,
            "jog refused: axis Y is at machine position 8.23708 mm, the end of its travel");
  EXPECT_CONTAINS(rig.jog(step(kY, -1e-6)).text, "jog refused: it would lead axis Y to machine position 8.23608 mm");
  release(rig);
  ASSERT_TRUE(rig.jog(step(kY, 0.01)).accepted);
  rig.runUntil(S::kRetracted);
  EXPECT_CONTAINS(rig.jog(step(kY, -0.0101)).text, "; allowed: down to 8.23708 mm");
  for (int i = 0; i < 3000; ++i) {
    if (i % 20 == 0) rig.loop->postJog(on(kY, -0.02));
    rig.cycle();
    static_cast<void>(rig.loop->jogReply());
  }
  EXPECT_EQ(rig.last().command[kY], clear);
  EXPECT_TRUE(rig.drive.written_drive.spindle) << "the wheel keeps turning";
}

TEST(JogRetracted, AStepThatIsTooShortForAnyNumberIsOverAtOnce) {
  RigIn rig(S::kRetracted);
  ASSERT_TRUE(rig.jog(step(kX, 1e-300)).accepted);
  EXPECT_EQ(rig.last().state, S::kRetracted);
  EXPECT_EQ(rig.loop->status().jogs_ended, 1U);
}

TEST(JogRetracted, AtTheEndOfThePathItIsRefused) {
  Rig<FakeDrive> rig;
  rig.startPaper();
  ASSERT_NO_FATAL_FAILURE(rig.runToCycle(planned().back().cycle));
  ASSERT_NO_FATAL_FAILURE(rig.hold());
  ASSERT_NO_FATAL_FAILURE(rig.retract());
  EXPECT_EQ(rig.jog(step(kX, 0.01)).text, "jog refused: the job has reached the end of its path; resume it first");
}

}  // namespace test_jog
}  // namespace grinder::test_support
