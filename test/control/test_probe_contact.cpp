#include "control/paper_job.h"

#include <cmath>

// Jogs that end where the measuring probe touches.
namespace grinder::test_support {
namespace test_probe_contact {

class ProbeFrom : public testing::TestWithParam<S> {
 protected:
  void SetUp() override {
    rig_.run(5);
    at_ = rig_.last().command;
    // The probe touches while X stands at or beyond it.
    wall_ = at_[kX] + 0.0123;
    rig_.drive.on_read = [this](FakeDrive& d) { d.status.probe_contact = d.position[kX] >= wall_; };
  }
  JogRequest step(double distance, double speed = 0.02) const { return {kX, false, distance, speed}; }

  RigIn rig_{GetParam()};
  Axes at_ = Axes::Zero();
  double wall_ = 0;
};

TEST_P(ProbeFrom, AStepEndsAtTheContactWhichIsKeptUntilTheNext) {
  const std::uint64_t ended = rig_.loop->status().jogs_ended;
  ASSERT_TRUE(rig_.jog(step(0.03)).accepted);
  EXPECT_EQ(rig_.loop->status().jogs_ended, ended);
  EXPECT_FALSE(rig_.loop->status().contact.made);
  rig_.runUntil(GetParam());
  const LoopStatus status = rig_.loop->status();
  EXPECT_EQ(status.jogs_ended, ended + 1);
  ASSERT_TRUE(status.contact.made);
  EXPECT_TRUE(status.probe_contact);
  // As read: the wall is met between two cycles, and rests where the speed of 0.02 m/s could be lost.
  EXPECT_GE(status.contact.position[kX], wall_);
  EXPECT_LT(status.contact.position[kX], wall_ + 0.02 * 0.001 * 1.01);
  EXPECT_EQ(status.contact.position[kA], at_[kA]);
  const double beyond = rig_.last().command[kX];
  EXPECT_GT(beyond, wall_);
  EXPECT_LT(beyond, wall_ + std::pow(0.02, 1.5) / std::sqrt(10.0) + 0.02 * 0.005);

  ASSERT_TRUE(rig_.jog(step(-0.002)).accepted) << "away from it";
  EXPECT_FALSE(rig_.loop->status().contact.made) << "of the jog before";
  rig_.runUntil(GetParam());
  EXPECT_EQ(rig_.last().command[kX], beyond - 0.002);
  EXPECT_FALSE(rig_.loop->status().contact.made);
  EXPECT_FALSE(rig_.loop->status().probe_contact);
  ASSERT_TRUE(rig_.jog(step(0.004, 0.002)).accepted);
  rig_.runUntil(GetParam());
  EXPECT_LT(rig_.loop->status().contact.position[kX], wall_ + 0.002 * 0.001 * 1.01);
  EXPECT_TRUE(smooth(rig_.log));
}

/// After a single cycle, what took it for a touch finds the axis at rest beyond the place, and the probe free.
TEST_P(ProbeFrom, OfAContactThatIsOverInACycleOrBouncesTheFirstIsKept) {
  bool over = false, bounces = false;
  rig_.drive.on_read = [&, wall = wall_](FakeDrive& d) {
    const bool beyond = d.position[kX] >= wall;
    d.status.probe_contact = beyond && (bounces ? d.status.feedback_count % 2 == 0 : !over);
    over |= beyond;
  };
  const auto expectContact = [&] {
    ASSERT_TRUE(rig_.jog(step(0.03)).accepted);
    rig_.runUntil(GetParam());
    EXPECT_TRUE(rig_.loop->status().contact.made);
    EXPECT_LT(rig_.loop->status().contact.position[kX], wall_ + 2 * 0.02 * 0.001 * 1.01);
    EXPECT_LT(rig_.last().command[kX], wall_ + 0.002);
  };
  expectContact();
  EXPECT_FALSE(rig_.loop->status().probe_contact);
  ASSERT_TRUE(rig_.jog(step(-0.005)).accepted);
  rig_.runUntil(GetParam());
  bounces = true;
  expectContact();
}

TEST_P(ProbeFrom, AButtonThatStaysPressedDoesNotPressOn) {
  double rested = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i % 20 == 0) {
      rig_.loop->postJog({kX, true, 0, 0.02});
    }
    rig_.cycle();
    static_cast<void>(rig_.loop->jogReply());
    if (i == 1000) rested = rig_.last().command[kX];
  }
  EXPECT_EQ(rig_.last().state, GetParam());
  EXPECT_EQ(rig_.last().command[kX], rested);
  EXPECT_GT(rested, wall_);
  EXPECT_LT(rested, wall_ + 0.002);
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(ProbeFrom, AStepOfASeriesIsRefusedAfterAnyStop) {
  JogRequest next = step(0.001);
  next.stops = rig_.loop->status().stops;
  ASSERT_TRUE(rig_.jog(next).accepted);
  rig_.runUntil(GetParam());
  ASSERT_TRUE(rig_.jog(next).accepted) << "no stop came";
  rig_.runUntil(GetParam());
  // Nothing moves, so that the hold has nothing to stop; it ends the series none the less.
  EXPECT_EQ(rig_.ask(E::kHold).accepted, false);
  const std::size_t rest = rig_.log.size() - 1;
  EXPECT_EQ(rig_.jog(next).text, "jog refused: a stop came first");
  rig_.run(10);
  EXPECT_TRUE(atRestFrom(rig_.log, rest));
  EXPECT_TRUE(rig_.jog(step(0.001)).accepted) << "by hand";
}

/// Steps of a probing cycle, which lasts as long as its client does.
class ProbeForClient : public ProbeFrom {
 protected:
  JogRequest next() const {
    JogRequest next = step(0.01);
    next.stops = rig_.loop->status().stops;
    next.for_client = true;
    return next;
  }
  void alive(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      if (i % 20 == 0) rig_.loop->keepAlive();
      rig_.cycle();
    }
  }
};

TEST_P(ProbeForClient, AStepEndsWithIt) {
  const JogRequest next = this->next();
  alive(1);
  ASSERT_TRUE(rig_.jog(next).accepted);
  alive(200);
  EXPECT_EQ(rig_.ask(E::kSpindleOn).text,
            "spindle on refused: a probing cycle is in progress; wait for its end, or cancel it");
  alive(1);
  const std::size_t last_message = rig_.log.size() - 1;
  EXPECT_GT(rig_.last().command[kX], at_[kX] + 0.002);
  rig_.runUntil(GetParam());
  // After the time-out of 0.0505 s and the way to stop from 0.02 m/s, short of the end.
  const double stopping = std::pow(0.02, 1.5) / std::sqrt(10.0);
  EXPECT_LT(rig_.last().command[kX], rig_.log[last_message].command[kX] + 0.02 * 0.055 + stopping);
  EXPECT_GT(rig_.log.size() - last_message, 30U);
  EXPECT_EQ(rig_.loop->status().stops, next.stops + 1) << "once";
  EXPECT_TRUE(rig_.loop->status().client_lost);
  alive(1);
  EXPECT_EQ(rig_.jog(next).text, "jog refused: a stop came first");
  ASSERT_TRUE(rig_.jog(this->next()).accepted);
  EXPECT_FALSE(rig_.loop->status().client_lost) << "of the step before";
  EXPECT_TRUE(smooth(rig_.log));
}

TEST_P(ProbeForClient, ALateHostIsNotItsSilence) {
  alive(1);
  ASSERT_TRUE(rig_.jog(next()).accepted);
  for (int i = 0; i < 7; ++i) rig_.cycle(9);  // 63 ms
  EXPECT_FALSE(rig_.loop->status().client_lost);
  for (int i = 0; i < 19; ++i) rig_.cycle(9);
  EXPECT_TRUE(rig_.loop->status().client_lost) << "after 26 cycles, of which each counts 2 ms";
}

TEST_P(ProbeForClient, NoStepBeginsWhileTheWheelTurns) {
  alive(1);
  const char* refused = "jog refused: the wheel turns; switch the spindle off first";
  rig_.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = true; };  // commanded by whatever else
  EXPECT_EQ(rig_.jog(next()).text, refused);
  rig_.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = false; };
  // In the cycle in which it is switched on, or only now off.
  for (const E event : {E::kSpindleOn, E::kSpindleOff}) {
    ASSERT_TRUE(rig_.loop->post(event));
    EXPECT_EQ(rig_.jog(next()).text, refused);
    EXPECT_TRUE(rig_.loop->reply().value_or(RequestReply{}).accepted);
  }
  EXPECT_TRUE((rig_.last().command == at_).all());
  rig_.cycle();
  EXPECT_TRUE(rig_.jog(next()).accepted);
}

TEST_P(ProbeForClient, AStepForOneThatIsGoneMovesNothing) {
  for (const int messages : {0, 1}) {
    alive(messages);
    const JogRequest next = this->next();
    rig_.run(100);
    const std::size_t rest = rig_.log.size() - 1;
    ASSERT_TRUE(rig_.jog(next).accepted);
    rig_.runUntil(GetParam());
    for (std::size_t i = rest; i < rig_.log.size(); ++i) EXPECT_TRUE((rig_.log[i].command == at_).all()) << i;
    EXPECT_EQ(rig_.loop->status().stops, next.stops + 1);
  }
}

INSTANTIATE_TEST_SUITE_P(, ProbeFrom, testing::Values(S::kReady, S::kRetracted), stateName);
INSTANTIATE_TEST_SUITE_P(, ProbeForClient, testing::Values(S::kReady), stateName);

}  // namespace test_probe_contact
}  // namespace grinder::test_support
