#include "control/rig.h"

#include <limits>

// Requests: enable, job starts, and what each state refuses.
namespace grinder::test_support {
namespace test_loop_requests {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// ---------------------------------------------------------------------------------------------------------------------
// Enable

TEST(ControlLoopEnable, IsAnsweredOncePowerIsThere) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  EXPECT_EQ(rig.cycle().state, S::kDisabled);
  EXPECT_TRUE(rig.drive.written_drive.enable);
  EXPECT_FALSE(rig.loop->reply());
  EXPECT_EQ(rig.cycle().state, S::kReady);
  const auto answer = rig.loop->reply();
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->accepted);
}

TEST(ControlLoopEnable, MovesNothing) {
  Rig<SimulatedDrive> rig;
  const Axes before = rig.run(2).position;
  rig.enable();
  rig.run(100);
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_TRUE(sameBits(rig.last().position, before)) << rig.last().position.transpose();
}

TEST(ControlLoopEnable, TakesTheCommandsFromThePositionsAtTheMomentOfPower) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.cycle();
  const Axes sagged(-0.0501, 0.0502, 0.0003, 0.004);
  rig.drive.on_read = [&](FakeDrive& drive) { drive.place(sagged); };
  rig.cycle();
  ASSERT_EQ(rig.last().state, S::kReady);
  EXPECT_TRUE(sameBits(toAxes(rig.drive.written), sagged));
}

struct RefusalCase {
  const char* name;
  std::function<void(FakeDrive&)> spoil;
  const char* reason;
};
std::ostream& operator<<(std::ostream& out, const RefusalCase& c) { return out << c.name; }

class EnableRefused : public testing::TestWithParam<RefusalCase> {};

TEST_P(EnableRefused, WithTheReasonAndWithoutPower) {
  Rig<FakeDrive> rig;
  rig.cycle();
  rig.drive.on_read = GetParam().spoil;
  rig.run(5);
  const RequestReply answer = rig.ask(E::kEnable);
  EXPECT_FALSE(answer.accepted);
  EXPECT_CONTAINS(answer.text, "enable refused");
  EXPECT_CONTAINS(answer.text, GetParam().reason);
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  rig.drive.on_read = nullptr;
  rig.run(5);
  EXPECT_EQ(rig.last().state, S::kDisabled) << "the refused request came back to life";
  EXPECT_FALSE(rig.drive.written_drive.enable);
}

INSTANTIATE_TEST_SUITE_P(
    , EnableRefused,
    testing::Values(
        RefusalCase{"EmergencyStop", [](FakeDrive& d) { d.status.emergency_stop = true; }, "emergency stop is pressed"},
        RefusalCase{"DriveFault", [](FakeDrive& d) { d.status.fault = true; }, "the drive reports a fault"},
        RefusalCase{"NanFeedback", [](FakeDrive& d) { d.position[kA] = kNan; }, "no valid, fresh positions"},
        RefusalCase{"InfiniteFeedback", [](FakeDrive& d) { d.position[kX] = HUGE_VAL; }, "no valid, fresh positions"},
        RefusalCase{"StaleFeedback", [](FakeDrive& d) { d.status.feedback_count = 1; }, "no valid, fresh positions"}),
    [](const testing::TestParamInfo<RefusalCase>& info) { return info.param.name; });

TEST(ControlLoopEnable, DistinguishesAFaultThatStaysAfterTheResetFromANewOne) {
  Rig<FakeDrive> rig;
  const auto refusal = [&] { return rig.ask(E::kEnable).text; };
  rig.drive.status.fault = true;
  rig.cycle();
  EXPECT_EQ(refusal(), "enable refused: the drive reports a fault; reset it first");
  ASSERT_TRUE(rig.ask(E::kReset).accepted);
  rig.run(5);
  EXPECT_EQ(refusal(), "enable refused: the drive still reports a fault after the reset; remove its cause");
  rig.drive.status.fault = false;
  rig.cycle();
  rig.drive.status.fault = true;
  rig.cycle();
  EXPECT_EQ(refusal(), "enable refused: the drive reports a fault; reset it first");
}

TEST(ControlLoopEnable, GivesUpWhenPowerDoesNotComeInTime) {
  Rig<FakeDrive> rig;  // 10.5 periods
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  for (int i = 0; i < 10; ++i) {
    rig.cycle();
    ASSERT_FALSE(rig.loop->reply()) << "after " << i + 1 << " cycles";
    ASSERT_TRUE(rig.drive.written_drive.enable);
  }
  rig.cycle();
  const auto answer = rig.loop->reply();
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->accepted);
  EXPECT_CONTAINS(answer->text, "did not switch its power on in time");
  EXPECT_FALSE(rig.drive.written_drive.enable);
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = true; };
  rig.run(5);
  EXPECT_EQ(rig.last().state, S::kDisabled) << "though it has come by now";
}

TEST(ControlLoopEnable, NeverWritesACommandThatIsNotANumber) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.cycle();
  // The encoder fails in the same cycle in which the power comes.
  rig.drive.on_read = [](FakeDrive& d) { d.position[kY] = kNan; };
  for (int i = 0; i < 5; ++i) {
    rig.cycle();
    EXPECT_TRUE(toAxes(rig.drive.written).isFinite().all()) << "in cycle " << i;
  }
}

TEST(ControlLoopEnable, AnEmergencyStopWhileWaitingForPowerTakesTheEnableBack) {
  Rig<FakeDrive> rig;
  rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  rig.run(2);
  rig.drive.on_read = [](FakeDrive& d) {
    d.status.enabled = false;
    d.status.emergency_stop = true;
  };
  rig.run(2);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = false; };
  rig.run(3);
  EXPECT_EQ(rig.last().state, S::kDisabled) << "releasing the emergency stop switched power on";
}

TEST(ControlLoopEnable, OneRequestAtATime) {
  Rig<FakeDrive> rig;
  rig.cycle();
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  EXPECT_FALSE(rig.loop->post(E::kReset));
}

// ---------------------------------------------------------------------------------------------------------------------
// Requests against the table

struct RequestCase {
  S state;
  E event;
  const char* allowed = "";  ///< what the refusal must list
};
std::ostream& operator<<(std::ostream& out, const RequestCase& c) {
  return out << toString(c.event) << " in " << toString(c.state);
}
std::string requestName(const testing::TestParamInfo<RequestCase>& info) {
  return std::string(toString(info.param.event)) + "_in_" + toString(info.param.state);
}

/// Every request in every state that does not allow it.
std::vector<RequestCase> refusedRequests() {
  const std::vector<std::pair<S, const char*>> allowed{
      {S::kDisabled, "enable, disable, reset"},
      {S::kReady, "enable, disable, home, start (grind run), lift, jog"},
      {S::kHoming, "disable, hold, cancel"},
      {S::kStarting, "disable, hold, resume, cancel"},
      {S::kRunning, "disable, hold, cancel"},
      {S::kHolding, "disable, hold, resume, cancel"},
      {S::kHeld, "disable, hold, resume, retract, cancel"},
      {S::kRetracting, "disable, hold, cancel"},
      {S::kRetracted, "disable, resume, cancel, jog"},
      {S::kResuming, "disable, hold, cancel"},
      {S::kCanceling, "disable, hold, cancel"},
      {S::kFault, "disable, reset"},
      {S::kLifting, "disable, hold, cancel"},
      {S::kJogging, "disable, hold, cancel, jog"},
      {S::kJoggingRetracted, "disable, hold, cancel, jog"}};
  const std::vector<std::pair<E, const char*>> requests{
      {E::kEnable, "enable"}, {E::kDisable, "disable"}, {E::kHome, "home"},       {E::kStart, "start (grind run)"},
      {E::kHold, "hold"},     {E::kResume, "resume"},   {E::kRetract, "retract"}, {E::kCancel, "cancel"},
      {E::kReset, "reset"},   {E::kLift, "lift"},       {E::kJog, "jog"}};
  std::vector<RequestCase> cases;
  for (const auto& [state, list] : allowed) {
    for (const auto& [event, name] : requests) {
      const bool listed = (", " + std::string(list) + ",").find(", " + std::string(name) + ",") != std::string::npos;
      if (!listed) cases.push_back({state, event, list});
    }
  }
  return cases;
}

class RequestRefused : public testing::TestWithParam<RequestCase> {};

TEST_P(RequestRefused, WithTheStateAndWhatItAllows) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, GetParam().state));
  SetpointStream other = rig.paperStream();
  const RequestReply answer = rig.ask(GetParam().event, &other);
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.text, std::string(toString(GetParam().event)) + " refused: the machine is in state " +
                             toString(GetParam().state) + "; allowed: " + GetParam().allowed);
  EXPECT_EQ(rig.last().state, GetParam().state);
}

INSTANTIATE_TEST_SUITE_P(, RequestRefused, testing::ValuesIn(refusedRequests()), requestName);

class RequestWithoutEffect : public testing::TestWithParam<RequestCase> {};

TEST_P(RequestWithoutEffect, IsAcceptedAndChangesNothing) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, GetParam().state));
  const bool enable = rig.drive.written_drive.enable;
  const RequestReply answer = rig.ask(GetParam().event);
  EXPECT_TRUE(answer.accepted) << answer.text;
  EXPECT_EQ(rig.last().state, GetParam().state);
  EXPECT_EQ(rig.drive.written_drive.enable, enable);
}

INSTANTIATE_TEST_SUITE_P(, RequestWithoutEffect,
                         testing::Values(RequestCase{S::kDisabled, E::kDisable}, RequestCase{S::kDisabled, E::kReset},
                                         RequestCase{S::kReady, E::kEnable}, RequestCase{S::kHolding, E::kHold},
                                         RequestCase{S::kHeld, E::kHold}, RequestCase{S::kStarting, E::kHold},
                                         RequestCase{S::kStarting, E::kResume}, RequestCase{S::kCanceling, E::kCancel},
                                         RequestCase{S::kCanceling, E::kDisable}, RequestCase{S::kCanceling, E::kHold},
                                         RequestCase{S::kFault, E::kDisable}, RequestCase{S::kLifting, E::kHold},
                                         RequestCase{S::kLifting, E::kCancel}, RequestCase{S::kLifting, E::kDisable},
                                         RequestCase{S::kJogging, E::kHold}, RequestCase{S::kJogging, E::kCancel},
                                         RequestCase{S::kJogging, E::kDisable},
                                         RequestCase{S::kJoggingRetracted, E::kHold}),
                         requestName);

// Events of the loop itself: from outside they would make the state inconsistent with the stream and the power.
class NotARequest : public testing::TestWithParam<E> {};

TEST_P(NotARequest, IsRefusedFromOutside) {
  RigIn rig(S::kRunning);
  EXPECT_FALSE(rig.ask(GetParam()).accepted);
  EXPECT_EQ(rig.last().state, S::kRunning);
}

INSTANTIATE_TEST_SUITE_P(, NotARequest, testing::Values(E::kDone, E::kAtRest, E::kFault),
                         [](const testing::TestParamInfo<E>& info) {
                           const std::string name = toString(info.param);
                           return name == "at rest" ? "at_rest" : name;
                         });

TEST(ControlLoopDisable, SwitchesPowerOffAndCommandsFollowThePositionsAgain) {
  Rig<FakeDrive> rig;
  rig.enable();
  ASSERT_TRUE(rig.ask(E::kDisable).accepted);
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_FALSE(rig.drive.written_drive.enable);
  const Axes pushed(0.01, 0.02, 0.03, 0.4);
  rig.drive.place(pushed);
  rig.cycle();
  EXPECT_TRUE(sameBits(toAxes(rig.drive.written), pushed));
}

// ---------------------------------------------------------------------------------------------------------------------
// Start

TEST(Start, IsRefusedAfterTheLeastMotionOfAnyAxis) {
  for (const int axis : {kX, kY, kZ, kA}) {
    Rig<FakeDrive> rig;
    rig.enable();
    Axes planned = rig.last().command;
    planned[axis] = std::nextafter(planned[axis], 1.0);
    SetpointStream stream = paperStream(machineConfig().machine, planned);
    const RequestReply answer = rig.askToStart(stream);
    EXPECT_FALSE(answer.accepted) << axis;
    EXPECT_CONTAINS(answer.text, "do not stand where the job was planned to start");
    EXPECT_EQ(rig.last().state, S::kReady);
    EXPECT_TRUE(rig.setpoints().empty());
  }
}

}  // namespace test_loop_requests
}  // namespace grinder::test_support
