#include "control/rig.h"

#include <functional>
#include <limits>
#include <utility>
#include <vector>

// Requests: enable, job starts, and what each state refuses.
namespace grinder::test_support {
namespace test_loop_requests {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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

TEST(ControlLoopEnable, IsRefusedWithTheReasonAndWithoutPower) {
  const RefusalCase rows[]{
      {"emergency stop", [](FakeDrive& d) { d.status.emergency_stop = true; }, "emergency stop is pressed"},
      {"drive fault", [](FakeDrive& d) { d.status.fault = true; }, "the drive reports a fault"},
      {"nan", [](FakeDrive& d) { d.position[kA] = kNan; }, "no valid, fresh positions"},
      {"infinity", [](FakeDrive& d) { d.position[kX] = HUGE_VAL; }, "no valid, fresh positions"},
      {"stale", [](FakeDrive& d) { d.status.feedback_count = 1; }, "no valid, fresh positions"},
      {"jumps", [](FakeDrive& d) { d.position[kX] += d.status.feedback_count % 2 == 0 ? 0.01 : -0.01; },
       "no valid, fresh positions"}};
  for (const RefusalCase& row : rows) {
    SCOPED_TRACE(row.name);
    Rig<FakeDrive> rig;
    rig.cycle();
    rig.drive.on_read = row.spoil;
    rig.run(5);
    const RequestReply answer = rig.ask(E::kEnable);
    EXPECT_FALSE(answer.accepted);
    EXPECT_CONTAINS(answer.text, "enable refused");
    EXPECT_CONTAINS(answer.text, row.reason);
    EXPECT_EQ(rig.last().state, S::kDisabled);
    EXPECT_FALSE(rig.drive.written_drive.enable);
    rig.drive.on_read = nullptr;
    rig.run(5);
    EXPECT_EQ(rig.last().state, S::kDisabled) << "the refused request came back to life";
    EXPECT_FALSE(rig.drive.written_drive.enable);
  }
}

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

TEST(ControlLoopEnable, GivesUpWhenPowerDoesNotComeInTimeOrThatOfBeforeStays) {
  for (const bool stays : {false, true}) {
    RigIn rig(stays ? S::kReady : S::kDisabled);
    rig.drive.on_read = [=](FakeDrive& d) { d.status.enabled = stays; };
    ASSERT_TRUE(rig.ask(E::kDisable).accepted);
    ASSERT_TRUE(rig.loop->post(E::kEnable));
    for (int i = 0; i < 10; ++i) {  // of 10.5 periods
      rig.cycle();
      ASSERT_FALSE(rig.loop->reply()) << "after " << i + 1 << " cycles";
      ASSERT_EQ(rig.drive.written_drive.enable, !stays);
    }
    rig.cycle();
    EXPECT_EQ(rig.loop->reply().value_or(RequestReply{}).text,
              stays ? "enable refused: the drive still reports power, though it was switched off; press the emergency "
                      "stop"
                    : "enable refused: the drive did not switch its power on in time");
    EXPECT_FALSE(rig.drive.written_drive.enable);
    rig.drive.on_read = [=](FakeDrive& d) { d.status.enabled = !stays; };
    rig.run(5);
    EXPECT_EQ(rig.last().state, S::kDisabled) << "what was refused comes later";
    EXPECT_FALSE(rig.drive.written_drive.enable);
  }
}

// Of a drive that switches off late.
TEST(ControlLoopEnable, IsAnsweredByPowerThatFollowsIt) {
  RigIn rig(S::kReady);
  bool powered = true;
  rig.drive.on_read = [&](FakeDrive& d) { d.status.enabled = powered; };
  ASSERT_TRUE(rig.ask(E::kDisable).accepted);
  ASSERT_TRUE(rig.loop->post(E::kEnable));
  const auto expect_nothing = [&](const char* why) {
    rig.run(3);
    EXPECT_FALSE(rig.loop->reply()) << why;
    EXPECT_EQ(rig.last().state, S::kDisabled) << why;
  };
  expect_nothing("the power is that of before");
  EXPECT_FALSE(rig.drive.written_drive.enable);
  powered = false;
  expect_nothing("there is no power");
  EXPECT_TRUE(rig.drive.written_drive.enable);
  powered = true;
  rig.cycle();
  EXPECT_TRUE(rig.loop->reply().value_or(RequestReply{}).accepted);
  EXPECT_EQ(rig.last().state, S::kReady);
}

TEST(ControlLoopEnable, IsTakenBackByADisableAnEmergencyStopOrAHangWhileThePowerIsAwaited) {
  const struct {
    void (*happen)(Rig<FakeDrive>& rig);
    const char* refused;
  } rows[]{{[](Rig<FakeDrive>& rig) { EXPECT_TRUE(rig.ask(E::kDisable).accepted); }, "disable came before the power"},
           {[](Rig<FakeDrive>& rig) { rig.drive.status.emergency_stop = true; },
            "the emergency stop is pressed; release it first"},
           {[](Rig<FakeDrive>& rig) { rig.loop->beginPowerOff(); },
            "the drive reports a fault: it has returned to the control loop too late; its powerOff() has not "
            "returned; reset it first"}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.refused);
    Rig<FakeDrive> rig;
    rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; };
    rig.cycle();
    ASSERT_TRUE(rig.loop->post(E::kEnable));
    rig.run(2);
    ASSERT_TRUE(rig.drive.written_drive.enable);
    row.happen(rig);
    rig.cycle();
    EXPECT_EQ(rig.loop->reply().value_or(RequestReply{}).text, std::string("enable refused: ") + row.refused);
    EXPECT_FALSE(rig.drive.written_drive.enable);
    rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = false; };
    rig.run(5);
    EXPECT_EQ(rig.last().state, S::kDisabled) << "the power was switched on by what was taken back";
    EXPECT_FALSE(rig.drive.written_drive.enable);
  }
}

/// Every request in every state that does not allow it.
TEST(Request, ThatAStateDoesNotAllowIsRefusedWithTheStateAndWhatItAllows) {
  const std::pair<S, const char*> allowed[]{{S::kDisabled, "enable, disable, reset"},
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
  const std::pair<E, const char*> requests[]{
      {E::kEnable, "enable"}, {E::kDisable, "disable"}, {E::kHome, "home"},       {E::kStart, "start (grind run)"},
      {E::kHold, "hold"},     {E::kResume, "resume"},   {E::kRetract, "retract"}, {E::kCancel, "cancel"},
      {E::kReset, "reset"},   {E::kLift, "lift"},       {E::kJog, "jog"}};
  for (const auto& [state, list] : allowed) {
    for (const auto& [event, name] : requests) {
      const bool listed = (", " + std::string(list) + ",").find(", " + std::string(name) + ",") != std::string::npos;
      if (listed) continue;
      RigIn rig(state);
      SetpointStream other = rig.paperStream();
      const RequestReply answer = rig.ask(event, &other);
      EXPECT_FALSE(answer.accepted);
      EXPECT_EQ(answer.text, std::string(toString(event)) + " refused: the machine is in state " + toString(state) +
                                 "; allowed: " + list);
      EXPECT_EQ(rig.last().state, state) << toString(event);
    }
  }
}

TEST(Request, ForWhatIsSoAlreadyIsAcceptedAndChangesNothing) {
  const std::pair<S, std::vector<E>> rows[]{{S::kDisabled, {E::kDisable, E::kReset}},
                                            {S::kReady, {E::kEnable}},
                                            {S::kHolding, {E::kHold}},
                                            {S::kHeld, {E::kHold}},
                                            {S::kStarting, {E::kHold, E::kResume}},
                                            {S::kCanceling, {E::kCancel, E::kDisable, E::kHold}},
                                            {S::kFault, {E::kDisable}}};
  for (const auto& [state, events] : rows) {
    for (const E event : events) {
      SCOPED_TRACE(testing::Message() << toString(event) << " in " << toString(state));
      RigIn rig(state);
      const bool enable = rig.drive.written_drive.enable;
      const RequestReply answer = rig.ask(event);
      EXPECT_TRUE(answer.accepted) << answer.text;
      EXPECT_EQ(rig.last().state, state);
      EXPECT_EQ(rig.drive.written_drive.enable, enable);
    }
  }
}

// Events of the loop itself: from outside they would make the state inconsistent with the stream and the power.
TEST(Request, ThatIsNoneIsNotTakenNorAStopThatIsNone) {
  RigIn rig(S::kRunning);
  for (const E event : {E::kDone, E::kAtRest, E::kFault}) {
    EXPECT_FALSE(rig.ask(event).accepted);
    EXPECT_EQ(rig.last().state, S::kRunning) << toString(event);
  }
  for (const E event : {E::kEnable, E::kHome, E::kStart, E::kReset, E::kDone, E::kFault, static_cast<E>(99)}) {
    rig.loop->postStop(event);
  }
  rig.run(3);
  EXPECT_EQ(rig.last().state, S::kRunning);
}

TEST(RequestSlot, ARequestThatIsWithdrawnIsNotTakenAndOneThatIsTakenIsAnswered) {
  RequestSlot<MachineEvent> slot;
  ASSERT_TRUE(slot.post(E::kHome));
  slot.withdraw();
  EXPECT_FALSE(slot.take().has_value());
  ASSERT_TRUE(slot.post(E::kResume));
  EXPECT_FALSE(slot.post(E::kReset));
  EXPECT_EQ(slot.take(), E::kResume);
  slot.withdraw();
  EXPECT_FALSE(slot.post(E::kHome)) << "it is being executed";
  slot.answer({});
  EXPECT_TRUE(slot.reply().has_value());
  EXPECT_TRUE(slot.post(E::kHome));
}

TEST(Start, IsRefusedAfterTheLeastMotionOfAnyAxis) {
  for (const int axis : {kX, kY, kZ, kA}) {
    Rig<FakeDrive> rig;
    rig.enable();
    Axes planned = rig.last().command;
    planned[axis] = std::nextafter(planned[axis], 1.0);
    SetpointStream stream = paperStream(machineConfig().machine, planned);
    const RequestReply answer = rig.askToStart(stream);
    EXPECT_FALSE(answer.accepted) << axis;
    EXPECT_CONTAINS(answer.text, "are not where the job was planned to start");
    EXPECT_EQ(rig.last().state, S::kReady);
    EXPECT_TRUE(rig.setpoints().empty());
  }
}

}  // namespace test_loop_requests
}  // namespace grinder::test_support
