#include "control/paper_job.h"

#include <cmath>
#include <exception>
#include <limits>

// Faults, and how the machine recovers from them.
namespace grinder::test_support {
namespace test_faults {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Thrown : std::exception {
  explicit Thrown(const char* words) : text(words) {}
  const char* what() const noexcept override { return text; }
  const char* text;
};

struct FaultCase {
  std::string name;
  FaultKind kind;
  std::vector<std::string> words;
  std::function<void(FakeDrive&)> spoil;
  int axis = 0;
  int cycles = 1;  ///< until it is to be seen
};

std::vector<FaultCase> faultCases() {
  using K = FaultKind;
  const std::string drive = "the drive reports a fault: ";
  const auto reports = [](const char* text) {
    return [=](FakeDrive& d) { d.status.fault = true, d.status.fault_text = text; };
  };
  const auto throws = [](const char* text) { return [=](FakeDrive&) { throw Thrown(text); }; };
  static const std::string long_text(200, 'x'), cut_off(FaultText::kMost - 23, 'x');
  std::vector<FaultCase> cases{
      {"EmergencyStop", K::kEmergencyStop, {"emergency stop"}, [](FakeDrive& d) { d.status.emergency_stop = true; }},
      {"InItsWords", K::kDriveFault, {drive + "overcurrent in X (code 12)"}, reports("overcurrent in X (code 12)")},
      {"ThatControlsATerminal", K::kDriveFault, {drive + "\\x1b[2J\\t\\xff"}, reports("\x1b[2J\t\xff")},
      {"InNoText", K::kDriveFault, {drive + "no text"}, reports(nullptr)},
      {"ThrowsNoText", K::kDriveFault, {drive + "no text (thrown by its read())"}, throws(nullptr)},
      {"ThrowsAnEmptyText", K::kDriveFault, {drive + "no text (thrown by its read())"}, throws("")},
      {"ThrowsALongText", K::kDriveFault, {drive + cut_off + " (thrown by its read())"}, throws(long_text.c_str())},
      {"ThrowsAnything",
       K::kDriveFault,
       {drive + "an exception that is no std::exception (thrown by its read())"},
       [](FakeDrive&) { throw 7; }},
      {"PowerLost", K::kPowerLost, {"switched its power off"}, [](FakeDrive& d) { d.status.enabled = false; }},
      // Fresh positions may be missing for 2.5 periods.
      {"StaleFeedback",
       K::kStaleFeedback,
       {"no fresh positions", "for 0.003 s", "allowed 0.0025 s"},
       [](FakeDrive& d) { --d.status.feedback_count; },
       0,
       3},
      {"FullTurn",
       K::kFollowingError,
       {"axis A following error 360", " deg", "limit 2.86479 deg"},
       [](FakeDrive& d) { d.position[kA] += 2 * std::acos(-1.0); },
       kA}};
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const std::string letter(1, axisLetter(axis));
    const std::string name = "axis " + letter;
    const auto n = static_cast<std::size_t>(axis);
    const auto reads = [=](double value) { return [=](FakeDrive& d) { d.position[n] = value; }; };
    cases.push_back({"Nan" + letter, K::kInvalidFeedback, {name + " position", "nan"}, reads(kNan), axis});
    cases.push_back({"Infinite" + letter, K::kInvalidFeedback, {name + " position", "-inf"}, reads(-HUGE_VAL), axis});
    const double limit = axis == kA ? 0.05 : 0.001;
    cases.push_back(
        {"Following" + letter,
         K::kFollowingError,
         {name + " following error", axis == kA ? "2.87" : "1.002 mm", axis == kA ? "limit 2.86479 deg" : "limit 1 mm"},
         [=](FakeDrive& d) { d.position[n] += limit * 1.002; },
         axis});
  }
  return cases;
}

TEST(FaultWhileRunning, EndsTheJobInItsCycleAndStays) {
  for (const FaultCase& c : faultCases()) {
    SCOPED_TRACE(c.name);
    Rig<FakeDrive> rig;
    rig.startPaper();
    ASSERT_NO_FATAL_FAILURE(rig.runTo(MoveKind::kStroke));
    rig.run(100);
    rig.drive.on_read = c.spoil;
    for (int i = 1; i < c.cycles; ++i) ASSERT_EQ(rig.cycle().state, S::kRunning) << "seen too early, in cycle " << i;
    const Axes last_written = toAxes(rig.drive.written);
    rig.cycle();
    EXPECT_EQ(rig.last().fault.axis, c.axis);
    for (const std::string& word : c.words) EXPECT_CONTAINS(rig.last().fault.text(), word);
    EXPECT_TRUE(rig.last().job_ended);
    for (int i = 0; i < 200; ++i) {
      ASSERT_EQ(rig.last().state, S::kFault) << i;
      ASSERT_EQ(rig.last().fault.kind, c.kind) << i;
      ASSERT_FALSE(rig.last().has_setpoint) << i;
      ASSERT_FALSE(rig.drive.written_drive.enable) << i;
      // Once it has gone, the commands follow the positions.
      ASSERT_TRUE(i > 100 || sameBits(toAxes(rig.drive.written), last_written)) << i;
      ASSERT_TRUE(i > 100 || sameBits(rig.last().command, last_written)) << i;
      if (i == 100) rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = d.status.fault = false; };
      rig.cycle();
    }
    EXPECT_EQ(rig.jobsEnded(), 1);
  }
}

/// Whether or not powerOff() has done anything.
TEST(ControlLoopFault, OfAHangIsFoundInAnyStateWithPowerWhenItEnds) {
  for (const S state : {S::kReady, S::kHoming, S::kStarting, S::kRunning, S::kHeld, S::kRetracted, S::kCanceling,
                        S::kLifting, S::kJogging}) {
    for (const bool enabled : {true, false}) {
      SCOPED_TRACE(testing::Message() << toString(state) << enabled);
      RigIn rig(state);
      rig.loop->beginPowerOff();
      rig.loop->endPowerOff();
      rig.drive.on_read = [&](FakeDrive& d) { d.status.enabled = enabled; };
      rig.cycle(400);
      EXPECT_EQ(rig.last().state, S::kFault);
      EXPECT_EQ(rig.last().fault.text(), "the drive reports a fault: it has returned to the control loop too late");
      EXPECT_EQ(rig.last().job_ended, isInJob(state));
      EXPECT_FALSE(rig.drive.written_drive.enable);
      rig.drive.on_read = nullptr;
      rig.run(3);
      ASSERT_NO_FATAL_FAILURE(rig.recover());
    }
  }
}

TEST(ControlLoopFault, OfAThrowingWriteEndsTheJobInTheNextCycle) {
  RigIn rig(S::kRunning);
  bool throws = true;
  rig.drive.on_write = [&] {
    if (throws) throw Thrown("the bus is down");
  };
  EXPECT_EQ(rig.cycle().state, S::kRunning);
  EXPECT_EQ(rig.cycle().state, S::kFault);
  EXPECT_EQ(rig.last().fault.text(), "the drive reports a fault: the bus is down (thrown by its write())");
  EXPECT_TRUE(rig.drive.written_drive.enable);  // which the bus has not passed on
  throws = false;
  rig.cycle();
  EXPECT_FALSE(rig.drive.written_drive.enable);
  ASSERT_NO_FATAL_FAILURE(rig.recover());
}

TEST(ControlLoopFault, OfADriveThatThrowsWithoutPowerRefusesThePower) {
  Rig<FakeDrive> rig;
  rig.drive.on_read = [](FakeDrive&) { throw Thrown("no answer"); };
  rig.cycle();
  EXPECT_FALSE(rig.loop->status().position_valid);
  rig.run(2);
  EXPECT_EQ(rig.drive.writes, 0) << "before the first reading 0 is no position";
  EXPECT_EQ(rig.last().state, S::kDisabled);
  EXPECT_EQ(rig.last().drive.fault_text.text(), "no answer (thrown by its read())");
  EXPECT_EQ(rig.ask(E::kEnable).text,
            "enable refused: the drive reports a fault: no answer (thrown by its read()); reset it first");
  rig.drive.on_read = nullptr;
  ASSERT_NO_FATAL_FAILURE(rig.enable());
}

TEST(ControlLoop, WritesNothingBeforeAllPositionsHaveBeenFinite) {
  Rig<FakeDrive> rig;
  rig.drive.on_read = [](FakeDrive& d) { d.position[kZ] = kNan; };
  rig.run(5);
  EXPECT_EQ(rig.drive.writes, 0);
  const Axes there(-0.03, 0.02, 0.001, 0.4);
  rig.drive.on_read = [&](FakeDrive& d) { d.place(there); };
  rig.cycle();
  EXPECT_EQ(rig.drive.writes, 1);
  EXPECT_TRUE(sameBits(toAxes(rig.drive.written), there));
  // Positions that are lost later do not keep the power from being switched off.
  rig.drive.on_read = [](FakeDrive& d) { d.position[kZ] = kNan; };
  rig.cycle();
  EXPECT_EQ(rig.drive.writes, 2);
  EXPECT_TRUE(sameBits(toAxes(rig.drive.written), there));
}

TEST(FaultText, CutsOffWhatIsTooLong) {
  FaultText text;
  text = "one";
  text += ", two";
  EXPECT_EQ(text.text(), "one, two");
  text = std::string(FaultText::kMost - 1, 'x');
  text += "yz";
  EXPECT_EQ(text.text(), std::string(FaultText::kMost - 1, 'x') + "y");
  text = "";
  EXPECT_TRUE(text.text().empty());
  FaultText end;
  end = "cd";
  text = "ab";
  text.endWith(end);
  EXPECT_EQ(text.text(), "abcd");
  text = std::string(FaultText::kMost, 'x');
  text.endWith(end);
  EXPECT_EQ(text.text(), std::string(FaultText::kMost - 2, 'x') + "cd");
}

/// With positions that are read in every cycle, or in every other one.
TEST(Enable, NeverCommandsAWrongReading) {
  LoopConfig config = machineConfig();
  config.enable_timeout = 1;
  const Axes at = config.machine.park;
  for (const int every : {1, 2}) {
    for (int wrong = 0; wrong <= 6; ++wrong) {
      SCOPED_TRACE(testing::Message() << wrong << " of every " << every);
      Rig<FakeDrive> rig(config);
      rig.run(3);
      rig.drive.on_read = [&, cycle = 0](FakeDrive& d) mutable {
        const int reading = cycle / every;
        if (cycle++ % every != 0) --d.status.feedback_count;
        d.status.enabled = d.status.enabled && reading >= 5;
        d.place(at);
        if (reading == wrong) d.position[kZ] += 0.01;
      };
      ASSERT_TRUE(rig.loop->post(E::kEnable));
      for (int i = 0; i < 40; ++i) {
        rig.cycle();
        ASSERT_TRUE(!rig.drive.written_drive.enable || sameBits(toAxes(rig.drive.written), at)) << i;
      }
      EXPECT_EQ(rig.last().state, wrong <= 5 ? S::kReady : S::kFault) << rig.last().fault.text();
    }
  }
}

/// Even while two readings disagree, though each is within the following error.
TEST(Enable, OfAMachineThatIsOnChangesNothing) {
  RigIn rig(S::kReady);
  rig.drive.on_read = [](FakeDrive& d) { d.position[kX] += d.status.feedback_count % 2 == 0 ? 0.8e-3 : -0.8e-3; };
  rig.run(2);
  EXPECT_TRUE(rig.ask(E::kEnable).accepted);
  EXPECT_TRUE(rig.drive.written_drive.enable);
  EXPECT_EQ(rig.run(20).state, S::kReady) << rig.last().fault.text();
}

TEST(ControlLoopReset, IsRefusedWhileTheEmergencyStopIsPressedAndCommandedForOneCycle) {
  RigIn rig(S::kFault);
  rig.drive.status.emergency_stop = true;
  EXPECT_EQ(rig.ask(E::kReset).text, "reset refused: the emergency stop is pressed; release it first");
  EXPECT_EQ(rig.last().state, S::kFault);
  EXPECT_FALSE(rig.drive.written_drive.reset);
  rig.drive.status.emergency_stop = false;
  ASSERT_TRUE(rig.ask(E::kReset).accepted);
  EXPECT_TRUE(rig.drive.written_drive.reset);
  rig.cycle();
  EXPECT_FALSE(rig.drive.written_drive.reset);
}

// The stream is planned for a stronger machine. Which setpoint it is, the check's own tests see.
TEST(ForbiddenSetpoint, IsNeverWrittenButAllBeforeItAreAndEndsTheJobWithoutPower) {
  using L = AxisLimits;
  using Q = LimitedQuantity;
  const struct {
    Axes L::*limits;
    int axis;
    double limit;
    Q quantity;
    const char *value, *bound, *place;  ///< in the fault's text, which begins with the first
  } rows[]{
      {&L::max_position, kX, 0.01, Q::kPosition, "axis X machine position 10.", "limit 10 mm", "(stroke,"},
      {&L::min_position, kY, 0.02125, Q::kPosition, "axis Y machine position 21.", "limit 21.25 mm", "(approach,"},
      {&L::max_velocity, kX, 0.05, Q::kVelocity, "axis X velocity 50.", "limit 50 mm/s", "(position,"},
      {&L::max_acceleration, kX, 0.21, Q::kAcceleration, "axis X acceleration 2", "limit 210 mm/s^2", "(position,"},
      {&L::max_jerk, kY, 3, Q::kJerk, "axis Y jerk", "limit 3000 mm/s^3", "(approach,"}};
  for (const auto& c : rows) {
    SCOPED_TRACE(c.value);
    LoopConfig tightened = machineConfig();
    (tightened.machine.limits.*c.limits)[c.axis] = c.limit;
    const Machine strong = machineConfig().machine;
    Rig<FakeDrive> rig(tightened);
    rig.enable();
    const std::vector<Setpoint> planned = allSetpoints(rig.paperStream(strong));
    rig.stream.emplace(rig.paperStream(strong));
    ASSERT_NO_FATAL_FAILURE(rig.start(*rig.stream));
    for (std::size_t i = 0; i < planned.size() && rig.last().state == S::kRunning; ++i) rig.cycle();
    ASSERT_EQ(rig.last().state, S::kFault) << "the limit was not seen";
    const LoopFault fault = rig.last().fault;
    EXPECT_EQ(fault.kind, FaultKind::kLimit);
    EXPECT_EQ(fault.axis, c.axis);
    EXPECT_EQ(fault.violation.axis, c.axis);
    EXPECT_EQ(fault.violation.quantity, c.quantity);
    const std::size_t forbidden = fault.violation.cycle;
    ASSERT_GT(forbidden, 0u);
    ASSERT_LT(forbidden, planned.size());
    EXPECT_EQ(fault.text().find(c.value), 0u) << fault.text();
    EXPECT_CONTAINS(fault.text(), std::string("beyond its ") + c.bound);
    EXPECT_CONTAINS(fault.text(), std::string(c.place) + " tooth 1, pass 1, X = ");
    EXPECT_TRUE(rig.last().job_ended);
    EXPECT_FALSE(rig.drive.written_drive.enable);
    rig.run(100);
    EXPECT_EQ(rig.jobsEnded(), 1);
    const std::vector<Setpoint> good(planned.begin(), planned.begin() + static_cast<std::ptrdiff_t>(forbidden));
    EXPECT_TRUE(sameSetpoints(rig.setpoints(), good));
    EXPECT_TRUE(sameBits(toAxes(rig.drive.written), good.back().position));
  }
}

TEST(PowerThatStaysOn, IsReportedAfterTheTimeInWhichItComesOn) {
  for (const S state : {S::kDisabled, S::kFault}) {
    SCOPED_TRACE(toString(state));
    RigIn rig(S::kReady);
    rig.drive.on_read = [=](FakeDrive& d) { d.status.enabled = true, d.status.emergency_stop = state == S::kFault; };
    if (state == S::kDisabled) rig.loop->postStop(E::kDisable);
    ASSERT_EQ(rig.cycle().state, state);
    // Powered for 10.5 periods at most.
    EXPECT_FALSE(rig.run(10).power_stays);
    EXPECT_TRUE(rig.run(1).power_stays);
    EXPECT_TRUE(rig.run(100).power_stays);
    rig.drive.on_read = nullptr;
    EXPECT_FALSE(rig.cycle().power_stays);
  }
  RigIn rig(S::kReady);
  EXPECT_FALSE(rig.run(100).power_stays);
}

TEST(FaultIn, AnyStateEndsTheJobAndNothingMovesUntilResetEnableAndStart) {
  for (const S state : {S::kReady, S::kHoming, S::kStarting, S::kRunning, S::kHolding, S::kHeld, S::kRetracting,
                        S::kRetracted, S::kResuming, S::kCanceling, S::kLifting, S::kJogging, S::kJoggingRetracted}) {
    SCOPED_TRACE(toString(state));
    RigIn rig(state);
    const bool in_work = rig.last().wheel_in_work;
    const int ended = rig.jobsEnded() + (isInJob(state) ? 1 : 0);
    const std::size_t standing = rig.log.size() - 1;
    rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = true; };
    ASSERT_EQ(rig.cycle().state, S::kFault);
    rig.drive.on_read = [](FakeDrive& d) { d.status.emergency_stop = false; };
    EXPECT_EQ(rig.last().job_ended, isInJob(state));
    EXPECT_EQ(rig.last().wheel_in_work, in_work);
    EXPECT_EQ(rig.loop->status().jogs_ended, rig.loop->status().jogs_begun);
    if (rig.loop->status().jobs_started > 0) {
      EXPECT_EQ(rig.loop->status().end, JobEnd::kFault);
      EXPECT_EQ(rig.loop->status().fault.kind,
                isInJob(state) ? FaultKind::kEmergencyStop : FaultKind::kDriveFault /* the job's own */);
    }
    const auto expectStanding = [&] {
      rig.run(50);
      EXPECT_TRUE(atRestFrom(rig.log, standing + 1));
      EXPECT_TRUE(sameBits(rig.last().command, rig.log[standing].command));
      EXPECT_FALSE(rig.drive.written_drive.spindle);
      EXPECT_FALSE(rig.drive.written_drive.coolant);
      EXPECT_FALSE(rig.drive.written_drive.home);
    };
    expectStanding();
    EXPECT_TRUE(rig.ask(E::kDisable).accepted);
    expectStanding();
    EXPECT_FALSE(rig.drive.written_drive.enable);
    ASSERT_TRUE(rig.ask(E::kReset).accepted);
    expectStanding();
    EXPECT_EQ(rig.last().state, S::kDisabled);
    EXPECT_FALSE(rig.drive.written_drive.enable);
    ASSERT_NO_FATAL_FAILURE(rig.enable());
    expectStanding();
    EXPECT_EQ(rig.last().state, S::kReady);
    EXPECT_EQ(rig.jobsEnded(), ended);

    EXPECT_EQ(rig.last().wheel_in_work, in_work);
    if (in_work) {
      ASSERT_NO_FATAL_FAILURE(rig.lift());
    }
    rig.keepLast();
    ASSERT_NO_FATAL_FAILURE(rig.startPaper());
    rig.runToEnd();
    expectCompleted(rig);
  }
}

}  // namespace test_faults
}  // namespace grinder::test_support
