#include "control/paper_job.h"

#include <functional>

// Spindle and coolant by hand: only on request, with the power on, without a job or with the wheel lifted in one, and
// never for longer.
namespace grinder::test_support {
namespace test_switches {

class Switches : public testing::Test {
 protected:
  void SetUp() override { rig.enable(); }
  /// What the drive is commanded to do, and what the sample says of it.
  std::string on() {
    const DriveCommand& c = rig.drive.written_drive;
    EXPECT_EQ(c.spindle, rig.last().spindle_commanded);
    EXPECT_EQ(c.coolant, rig.last().coolant_commanded);
    return std::string(c.spindle ? "spindle " : "") + (c.coolant ? "coolant" : "");
  }
  void switchBothOn() {
    ASSERT_TRUE(rig.ask(E::kSpindleOn).accepted);
    ASSERT_TRUE(rig.ask(E::kCoolantOn).accepted);
    rig.run(1000);
    ASSERT_EQ(on(), "spindle coolant");
    ASSERT_EQ(rig.last().state, S::kReady);
  }

  Rig<FakeDrive> rig;
};

TEST(DriveCapabilities, WhatTheDriveCannotDoIsRefused) {
  Rig<FakeDrive> rig(machineConfig(), [](FakeDrive& drive) { drive.can = {}; });
  rig.enable();
  EXPECT_EQ(rig.ask(E::kHome).text, "home refused: the drive does not home the axes");
  EXPECT_EQ(rig.ask(E::kSpindleOn).text, "spindle on refused: the drive does not switch the spindle");
  EXPECT_EQ(rig.ask(E::kCoolantOn).text, "coolant on refused: the drive does not switch the coolant");
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_FALSE(rig.drive.written_drive.home || rig.drive.written_drive.spindle || rig.drive.written_drive.coolant);
  for (const E off : {E::kSpindleOff, E::kCoolantOff}) EXPECT_TRUE(rig.ask(off).accepted) << "refused in a job alone";
  ASSERT_NO_FATAL_FAILURE(bringTo(rig, S::kRetracted));
  EXPECT_EQ(rig.ask(E::kSpindleOff).text, "spindle off refused: the drive does not switch the spindle");
  EXPECT_EQ(rig.ask(E::kCoolantOff).text, "coolant off refused: the drive does not switch the coolant");
  ASSERT_TRUE(rig.ask(E::kResume).accepted) << "they are on";
}

/// And neither the power nor what else ends such a state switches on again.
TEST_F(Switches, DisableAFaultAndHomingSwitchOffAtOnce) {
  const struct {
    const char* name;
    S then;
    std::function<void()> act;
  } rows[]{{"disable", S::kDisabled, [&] { EXPECT_TRUE(rig.ask(E::kDisable).accepted); }},
           {"homing", S::kHoming, [&] { EXPECT_TRUE(rig.ask(E::kHome).accepted); }},
           {"emergency stop", S::kFault, [&] { rig.drive.status.emergency_stop = true; }},
           {"drive fault", S::kFault, [&] { rig.drive.status.fault = true; }},
           {"lost power", S::kFault, [&] { rig.drive.on_read = [](FakeDrive& d) { d.status.enabled = false; }; }}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    ASSERT_NO_FATAL_FAILURE(switchBothOn());
    row.act();
    if (rig.last().state == S::kReady) rig.cycle();
    EXPECT_EQ(rig.last().state, row.then);
    EXPECT_EQ(on(), "");
    rig.drive.on_read = nullptr;
    rig.drive.status.emergency_stop = rig.drive.status.fault = false;
    ASSERT_TRUE(rig.ask(E::kDisable).accepted);
    ASSERT_NO_FATAL_FAILURE(rig.recover());
    rig.run(10);
    EXPECT_EQ(on(), "");
  }
}

TEST_F(Switches, TheSpindleDoesNotTurnWithTheProbeInItsWay) {
  switchBothOn();
  rig.drive.status.probe_free = false;
  rig.cycle();
  EXPECT_EQ(on(), "coolant");
  const RequestReply reply = rig.ask(E::kSpindleOn);
  EXPECT_FALSE(reply.accepted);
  EXPECT_EQ(reply.text, std::string("spindle on refused: ") + toString(Interlock::kProbe));
  rig.drive.status.probe_free = true;
  rig.run(5);
  EXPECT_EQ(on(), "coolant") << "it waits for another request";
  EXPECT_TRUE(rig.ask(E::kSpindleOn).accepted);
}

TEST_F(Switches, TheyStayOnWhileAnAxisIsJogged) {
  switchBothOn();
  ASSERT_TRUE(rig.ask(E::kJog).accepted);
  rig.run(30);
  ASSERT_EQ(rig.last().state, S::kJogging);
  EXPECT_EQ(on(), "spindle coolant");
  ASSERT_TRUE(rig.ask(E::kCoolantOff).accepted);
  ASSERT_TRUE(rig.ask(E::kHold).accepted);
  rig.runUntil(S::kReady);
  EXPECT_EQ(on(), "spindle ");
  // A jog that the power ends ends them too.
  ASSERT_TRUE(rig.ask(E::kJog).accepted);
  ASSERT_TRUE(rig.ask(E::kDisable).accepted);
  rig.runUntil(S::kDisabled);
  EXPECT_EQ(on(), "");
}

TEST(SwitchesInStates, AreAllowedAsTheTableSays) {
  for (const auto& row : kMachineStates) {
    SCOPED_TRACE(row.name);
    RigIn rig(row.value);
    const bool job = isInJob(row.value);
    const bool lifted = row.value == S::kRetracted || row.value == S::kJoggingRetracted;
    const bool may_be_on = row.value == S::kReady || row.value == S::kJogging || lifted;
    for (const E event : {E::kSpindleOn, E::kCoolantOn}) EXPECT_EQ(rig.ask(event).accepted, may_be_on);
    for (const E event : {E::kSpindleOff, E::kCoolantOff}) EXPECT_EQ(rig.ask(event).accepted, !job || lifted);
    EXPECT_EQ(rig.last().state, row.value);
  }
}

/// What an operator does to look at the tool: of the wheel, or of the coolant.
struct Switch {
  const char* name;
  E off, on;
  bool DriveCommand::*command;
  bool DriveStatus::*reading;
  const char* resume_refused;
};
constexpr Switch kSwitches[]{{"spindle", E::kSpindleOff, E::kSpindleOn, &DriveCommand::spindle,
                              &DriveStatus::spindle_at_speed, "resume refused: the spindle is not at speed"},
                             {"coolant", E::kCoolantOff, E::kCoolantOn, &DriveCommand::coolant,
                              &DriveStatus::coolant_on, "resume refused: no coolant flows"}};

TEST(SwitchesInAJob, WhatIsOffKeepsALiftedWheelFromTheWorkUntilItIsOnAndReady) {
  for (const Switch& part : kSwitches) {
    SCOPED_TRACE(part.name);
    RigIn rig(S::kRetracted);
    const auto reads = [&](bool value) {
      rig.drive.on_read = [&part, value](FakeDrive& drive) { drive.status.*part.reading = value; };
    };
    const std::size_t lifted = rig.log.size() - 1;
    reads(true);  // It runs down, or nobody measures it.
    ASSERT_TRUE(rig.ask(part.off).accepted);
    EXPECT_FALSE(rig.drive.written_drive.*part.command);
    EXPECT_NE(rig.drive.written_drive.spindle, rig.drive.written_drive.coolant) << "the other stays on";
    EXPECT_EQ(rig.ask(E::kResume).text, part.resume_refused);
    reads(false);
    rig.run(1000);
    EXPECT_FALSE(rig.drive.written_drive.*part.command);
    EXPECT_EQ(rig.ask(E::kResume).text, part.resume_refused);
    EXPECT_FALSE(rig.drive.written_drive.*part.command) << "a resume switches nothing on";
    ASSERT_TRUE(rig.ask(part.on).accepted);
    EXPECT_TRUE(rig.drive.written_drive.*part.command);
    rig.run(20);
    EXPECT_EQ(rig.ask(E::kResume).text, part.resume_refused) << "while it runs up";
    EXPECT_EQ(rig.last().state, S::kRetracted);
    EXPECT_TRUE(atRestFrom(rig.log, lifted));
    EXPECT_EQ(rig.last().interlock, Interlock::kNone) << "the loop did not hold the job";
    rig.drive.status.homed = false;
    EXPECT_EQ(rig.cycle().interlock, Interlock::kNotHomed) << "which nobody switched off";
    rig.drive.status.homed = true;
    rig.drive.on_read = nullptr;
    rig.run(2);
    ASSERT_TRUE(rig.ask(E::kResume).accepted);
    rig.runToEnd();
    expectCompleted(rig);
  }
}

TEST(SwitchesInAJob, WhatIsLostAfterTheStartOrTheResumeTakesTheWheelOffTheWork) {
  for (const S state : {S::kReady, S::kRetracted}) {
    RigIn rig(state);
    ASSERT_TRUE(rig.ask(E::kSpindleOff).accepted);
    ASSERT_TRUE(rig.ask(E::kSpindleOn).accepted);
    rig.run(2);
    if (state == S::kReady) {
      ASSERT_NO_FATAL_FAILURE(rig.startPaper());
    } else {
      ASSERT_TRUE(rig.ask(E::kResume).accepted);
    }
    rig.run(50);
    rig.drive.on_read = [](FakeDrive& drive) { drive.status.spindle_at_speed = false; };
    EXPECT_EQ(rig.cycle().interlock, Interlock::kSpindle);
    EXPECT_EQ(rig.last().state, S::kHolding);
  }
}

TEST(DistanceToGo, IsThatOfAJogByADistance) {
  Rig<FakeDrive> rig;
  rig.enable();
  EXPECT_TRUE((rig.last().distance_to_go == 0).all());
  const double end = rig.last().position[kY] + 0.02;
  ASSERT_TRUE(rig.jog({kY, false, 0.02, 0.05}).accepted);
  while (rig.cycle().state == S::kJogging) {
    Axes expected = Axes::Zero();
    expected[kY] = end - rig.last().position[kY];
    EXPECT_TRUE(((rig.last().distance_to_go - expected).abs() < 1e-12).all());
  }
  EXPECT_TRUE((rig.last().distance_to_go == 0).all());
  ASSERT_TRUE(rig.jog({kX, true, 0, 0.05}).accepted);
  rig.run(30);
  EXPECT_TRUE((rig.last().distance_to_go == 0).all()) << "it has no end of its own";
}

TEST(DistanceToGo, OfAJobEndsWithEachMove) {
  Rig<FakeDrive> rig;
  ASSERT_NO_FATAL_FAILURE(rig.startPaper());
  const std::vector<Move> moves = rig.stream->program().moves();
  ASSERT_NO_FATAL_FAILURE(rig.runTo(MoveKind::kStroke));
  const std::uint32_t stroke = rig.last().setpoint.move_index;
  int cycles = 0;
  while (rig.last().setpoint.move_index == stroke) {
    // This drive reaches each command in the next cycle.
    ASSERT_EQ(rig.loop->status().place.move_index, (rig.log.end() - 2)->setpoint.move_index);
    const Axes expected = moves[rig.loop->status().place.move_index].to - rig.last().position;
    ASSERT_TRUE(((rig.last().distance_to_go - expected).abs() < 1e-12).all());
    ++cycles;
    rig.cycle();
  }
  EXPECT_GT(cycles, 1000);
  // The last setpoint of the stroke is where it ends.
  EXPECT_LT((moves[stroke].to - rig.last().position).abs().maxCoeff(), 1e-9);
  rig.runToEnd();
  rig.run(5);
  EXPECT_TRUE((rig.last().distance_to_go == 0).all());
}

}  // namespace test_switches
}  // namespace grinder::test_support
