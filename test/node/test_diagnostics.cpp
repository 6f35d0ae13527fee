#include "node/diagnostics.h"

#include "control/fixtures.h"
#include "node/recorder_watch.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <limits>
#include <map>
#include <string>

namespace grinder {
namespace test_diagnostics {

using diagnostic_msgs::DiagnosticStatus;
using Report = void (Diagnostics::*)(Diagnostics::Status&);
using Values = std::map<std::string, std::string>;

constexpr int kOk = DiagnosticStatus::OK, kWarn = DiagnosticStatus::WARN, kError = DiagnosticStatus::ERROR;
constexpr Report kLoop = &Diagnostics::reportLoop, kDrive = &Diagnostics::reportDrive,
                 kFollowing = &Diagnostics::reportFollowing, kLimits = &Diagnostics::reportLimits,
                 kBuffer = &Diagnostics::reportBuffer, kJournal = &Diagnostics::reportJournal,
                 kHistory = &Diagnostics::reportHistory;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

DiagnosticThresholds thresholds() { return {{0.01, 0.25}, {0.5, 0.9}, {0.8, 1.000001}, {0.5, 0.2}}; }

/// Made-up samples of a powered machine, a millisecond each, and what the diagnostics say of them.
class DiagnosticsTest : public ::testing::Test {
 protected:
  DiagnosticsTest() {
    sample_.period = 0.001;
    sample_.state = MachineState::kReady;
    sample_.drive.enabled = sample_.drive.homed = true;
  }

  void watch(int cycles = 1) {
    for (; cycles > 0; --cycles) {
      sample_.feedback_age = 0;
      diagnostics_.add(sample_);
    }
  }

  /// A cycle without fresh positions.
  void watchStale() {
    sample_.feedback_age += sample_.period;
    diagnostics_.add(sample_);
  }

  Diagnostics::Status ask(Report report) {
    Diagnostics::Status status;
    (diagnostics_.*report)(status);
    return status;
  }
  int levelOf(Report report) { return ask(report).level; }

  /// Asks, and expects this answer, and these values of it.
  Diagnostics::Status expect(Report report, int level, const std::string& message, const Values& values = {}) {
    const Diagnostics::Status status = ask(report);
    EXPECT_EQ(status.level, level) << status.message;
    EXPECT_EQ(status.message, message);
    for (const auto& [key, expected] : values) EXPECT_EQ(value(status, key), expected) << key;
    return status;
  }

  static std::string value(const Diagnostics::Status& status, const std::string& key) {
    for (const auto& item : status.values) {
      if (item.key == key) return item.value;
    }
    return "no " + key;
  }
  static double number(const Diagnostics::Status& status, const std::string& key) {
    return std::stod(value(status, key));
  }

  /// Watches a setpoint at the positions, the next of its job.
  void write(const Axes& position) {
    sample_.state = MachineState::kRunning;
    sample_.has_setpoint = true;
    sample_.setpoint.cycle = next_cycle_++;
    sample_.setpoint.position = position;
    sample_.command = position;
    watch();
    sample_.has_setpoint = false;
  }

  LoopConfig config_ = test_support::machineConfig();
  Scheduling scheduling_{true, true};
  Diagnostics diagnostics_{config_, thresholds(), [this] { return scheduling_; }};
  CycleSample sample_;
  std::uint64_t next_cycle_ = 0;
};

TEST_F(DiagnosticsTest, LoopThatHasNotRunOrStopsIsAnError) {
  expect(kLoop, kError, "not running");
  watch(10);
  EXPECT_EQ(levelOf(kLoop), kOk);
  EXPECT_EQ(levelOf(kLoop), kError);
}

TEST_F(DiagnosticsTest, LoopReportsItsPeriods) {
  watch(3);
  sample_.period = 0.0012;
  watch();
  expect(kLoop, kOk, "running",
         {{"State", "ready"},
          {"Nominal period [s]", "0.001"},
          {"Mean period [s]", "0.00105"},
          {"Longest period [s]", "0.0012"},
          {"Late cycles", "0"},
          {"Cycles", "4"}});
}

TEST_F(DiagnosticsTest, LoopReportsItsCyclesDurationsAndItsWakeUpsDelays) {
  sample_.busy = 2e-6;
  watch(60);
  sample_.busy = 5e-6;
  sample_.period = 0.00103;
  watch(39);
  sample_.busy = 70e-6;
  sample_.period = 0.0012;
  watch();
  const auto status = expect(kLoop, kOk, "running",
                             {{"Longest cycle duration [s]", "7e-05"},
                              {"Median wake-up delay [s]", "0"},
                              {"Longest wake-up delay [s]", "0.0002"}});
  // Quantiles are reported to 4.4 %.
  EXPECT_NEAR(number(status, "Median cycle duration [s]"), 2e-6, 0.1e-6);
  EXPECT_NEAR(number(status, "99 % cycle duration [s]"), 5e-6, 0.25e-6);
  EXPECT_NEAR(number(status, "99 % wake-up delay [s]"), 30e-6, 1.5e-6);

  sample_.busy = 1e-6;
  sample_.period = 0.0009;
  watch();
  expect(kLoop, kOk, "running", {{"Longest cycle duration [s]", "1e-06"}, {"Longest wake-up delay [s]", "0"}});
}

TEST_F(DiagnosticsTest, LateCyclesAreAWarningAndThenAnError) {
  const struct {
    int late, level;
    const char* message;
  } rows[]{{1, kOk, "running"},
           {2, kWarn, "2 of 100 cycles were late"},
           {25, kWarn, "25 of 100 cycles were late"},
           {26, kError, "26 of 100 cycles were late"},
           {0, kOk, "running"}};
  for (const auto& row : rows) {
    sample_.period = 0.0016;
    watch(row.late);
    sample_.period = 0.0015;  // not late yet
    watch(100 - row.late);
    expect(kLoop, row.level, row.message);
  }
}

TEST_F(DiagnosticsTest, SchedulingThatWasNotGrantedIsAWarning) {
  scheduling_ = {false, true};
  watch();
  expect(kLoop, kWarn, "no real-time scheduling");
  scheduling_ = {true, false};
  watch();
  expect(kLoop, kWarn, "memory is not locked", {{"Memory locked", "False"}});
}

TEST_F(DiagnosticsTest, WhatIsLostOrMissedIsAnErrorOnce) {
  sample_.samples_lost = 7;
  sample_.drive.commands_waiting = 50;
  sample_.drive.underruns = 3;
  watch();
  expect(kLoop, kError, "7 cycle samples were lost");
  expect(kBuffer, kError, "3 underruns");
  watch();
  expect(kLoop, kOk, "running", {{"Samples lost", "7"}});
  expect(kBuffer, kOk, "filled", {{"Underruns", "3"}});
}

TEST_F(DiagnosticsTest, DriveIsOkWhenHomedAndItsInterlocksAreClosed) {
  watch();
  expect(kDrive, kOk, "enabled");
  sample_.drive.enabled = false;
  watch();
  expect(kDrive, kOk, "disabled", {{"Enabled", "False"}});
  sample_.power_stays = true;
  watch();
  expect(kDrive, kError, "the drive still reports power, though it was switched off");
  sample_.power_stays = false;
  sample_.drive.homed = false;
  watch();
  expect(kDrive, kWarn, "not homed");
  sample_.drive.homed = true;
  sample_.interlock = Interlock::kCoolant;
  watch();
  expect(kDrive, kWarn, "no coolant flows");
}

TEST_F(DiagnosticsTest, OneCycleOfEmergencyStopIsNotMissed) {
  sample_.drive.emergency_stop = true;
  watch();
  sample_.drive.emergency_stop = false;
  watch(100);
  expect(kDrive, kError, "emergency stop", {{"Emergency stop", "True"}});
  watch();
  EXPECT_EQ(levelOf(kDrive), kOk);
}

TEST_F(DiagnosticsTest, FaultIsReportedOnceAndWithAllElse) {
  sample_.state = MachineState::kFault;
  sample_.fault.kind = FaultKind::kEmergencyStop;
  sample_.drive.emergency_stop = sample_.drive.fault = true;
  sample_.drive.homed = false;
  watch();
  expect(kDrive, kError, "emergency stop; the drive reports a fault; not homed");
}

TEST_F(DiagnosticsTest, FeedbackAgeIsTheLongest) {
  watch();
  watchStale();
  watchStale();
  watch();
  // 2 ms of 2.5 ms
  expect(kDrive, kOk, "enabled", {{"Longest feedback age [s]", "0.002"}, {"Allowed feedback age [s]", "0.0025"}});
  for (int i = 0; i < 3; ++i) watchStale();
  expect(kDrive, kError, "no fresh positions for 0.003 s");
}

TEST_F(DiagnosticsTest, PositionThatIsNoNumberIsAnError) {
  sample_.position[kZ] = kNan;
  watch();
  sample_.position[kZ] = 0;
  watch();
  expect(kDrive, kError, "axis_z position is nan");
  const auto following = ask(kFollowing);
  EXPECT_EQ(following.level, kError);
  EXPECT_EQ(value(following, "axis_z max [m]"), "nan");
}

TEST_F(DiagnosticsTest, FollowingErrorIsTheMaxOfEachAxisAndAWarningAndThenAnError) {
  sample_.command_in_effect << 0.1, 0, 0, 3;
  sample_.position << 0.1004, 0, 0, 3;
  watch();
  sample_.position << 0.1, 0.0002, 0, 2.975;
  watch();
  const auto status = ask(kFollowing);
  EXPECT_EQ(status.level, kOk);
  for (const auto& [key, expected] : Values{{"axis_x max [m]", "0.0004"},
                                            {"axis_x of the allowed [%]", "40"},
                                            {"axis_y of the allowed [%]", "20"},
                                            {"axis_z of the allowed [%]", "0"},
                                            {"axis_a max [rad]", "0.025"}}) {
    EXPECT_EQ(value(status, key), expected);
  }
  sample_.position << 0.1, 0.0006, 0, 3;
  watch();
  expect(kFollowing, kWarn, "axis_y 0.0006 m of 0.001 m");
  sample_.position[kA] = 2.954;
  watch();
  expect(kFollowing, kError, "axis_y 0.0006 m of 0.001 m; axis_a 0.046 rad of 0.05 rad");
  sample_.position = sample_.command_in_effect;
  watch();
  EXPECT_EQ(levelOf(kFollowing), kOk);
}

TEST_F(DiagnosticsTest, FollowingErrorCountsInTheCycleOfTheFaultAndNotAfter) {
  watch();
  sample_.state = MachineState::kFault;
  sample_.position[kX] = 0.002;
  watch();
  EXPECT_EQ(levelOf(kFollowing), kError);
  watch();
  EXPECT_EQ(levelOf(kFollowing), kOk);
  sample_.state = MachineState::kDisabled;
  watch();
  EXPECT_EQ(levelOf(kFollowing), kOk);
}

TEST_F(DiagnosticsTest, MarginOfPositionIsTheNearerLimits) {
  // X from -0.1 to 0.3: 0.05 of half a range of 0.2 are left; Y from -0.02 to 0.15: 0.015 of 0.085.
  write({-0.05, 0.135, 0.025, 0});
  const auto status = expect(kLimits, kWarn, "axis_y position at 82.3529 % of its limit",
                             {{"axis_x position margin [%]", "25"}, {"axis_z position margin [%]", "100"}});
  EXPECT_NEAR(number(status, "axis_y position margin [%]"), 100 * 0.015 / 0.085, 1e-4);
}

TEST_F(DiagnosticsTest, MarginOfMotionIsThatOfThePositionsWritten) {
  // At 1 kHz: 0.15 of 0.2 m/s, and half of A's 12.566 rad/s; at 2 ms: 0.2 m/s^2 of 0.5, over it 5 m/s^3 of 10.
  const auto writeEven = [&](int from, int to) {
    for (int i = from; i <= to; ++i) write({0.1 + 0.00015 * i, 0.065, 0.025, 0.006283 * i});
  };
  writeEven(0, 40);
  ask(kLimits);
  writeEven(41, 60);
  const auto even = ask(kLimits);
  EXPECT_EQ(even.level, kOk);
  EXPECT_EQ(value(even, "Setpoints"), "20");
  EXPECT_NEAR(number(even, "axis_x velocity margin [%]"), 25, 1e-3);
  EXPECT_NEAR(number(even, "axis_a velocity margin [%]"), 50, 1e-3);
  EXPECT_NEAR(number(even, "axis_x acceleration margin [%]"), 100, 1e-3);
  EXPECT_NEAR(number(even, "axis_y velocity margin [%]"), 100, 1e-9);

  // Half a cycle pair's worth of 0.2 m/s^2 more.
  const double x = 0.1 + 0.00015 * 60;
  write({x + 0.00015 + 0.0000004, 0.065, 0.025, 0.006283 * 61});
  write({x + 0.0003 + 0.0000008, 0.065, 0.025, 0.006283 * 62});
  const auto bent = ask(kLimits);
  EXPECT_NEAR(number(bent, "axis_x acceleration margin [%]"), 100 - 100 * 0.2 / 0.5, 1e-2);
  // From none to 0.2 m/s^2 in 2 ms are 100 m/s^3.
  EXPECT_NEAR(number(bent, "axis_x jerk margin [%]"), 100 - 100 * 100 / 10, 1);
  EXPECT_EQ(bent.level, kError);
  EXPECT_CONTAINS(bent.message, "axis_x jerk at 1000 % of its limit");
}

TEST_F(DiagnosticsTest, UseOfALimitIsAWarning) {
  write({0.1, 0.065, 0.025, 0});
  write({0.1, 0.065 + 0.00009, 0.025, 0});
  expect(kLimits, kWarn, "axis_y velocity at 90 % of its limit");
}

TEST_F(DiagnosticsTest, SetpointsAfterAGapOrOfTheNextJobAreNotComparedWithThoseBefore) {
  write({0.1, 0.065, 0.025, 0});
  ask(kLimits);
  next_cycle_ = 1001;
  for (int i = 0; i < 30; ++i) write({0.2 + 0.00015 * i, 0.065, 0.025, 0});
  const auto status = ask(kLimits);
  EXPECT_EQ(status.level, kOk) << status.message;
  EXPECT_NEAR(number(status, "axis_x velocity margin [%]"), 25, 1e-3);
  EXPECT_NEAR(number(status, "axis_x jerk margin [%]"), 100, 1e-3);
  next_cycle_ = 0;
  write({0.1, 0.065, 0.025, 0});
  const auto next = ask(kLimits);
  EXPECT_EQ(next.level, kOk) << next.message;
  EXPECT_EQ(value(next, "axis_x velocity margin [%]"), "100");
}

TEST_F(DiagnosticsTest, SetpointsThatWereRefusedAreErrorsOnce) {
  const struct {
    int axis;
    LimitedQuantity quantity;
    double value, limit;
    const char *message, *name, *margin;
  } rows[]{{kA, LimitedQuantity::kVelocity, -25.132, 12.566, "axis_a velocity at 200 % of its limit",
            "axis_a velocity margin [%]", "-100"},
           // 0.25 from the middle of -0.1 to 0.3, of 0.2.
           {kX, LimitedQuantity::kPosition, 0.35, 0.3, "axis_x position at 125 % of its limit",
            "axis_x position margin [%]", "-25"},
           {kX, LimitedQuantity::kNotFinite, kNan, 0.3, "axis_x position at nan % of its limit",
            "axis_x position margin [%]", "nan"}};
  for (const auto& row : rows) {
    sample_.state = MachineState::kReady;
    watch();
    sample_.state = MachineState::kFault;
    sample_.fault.kind = FaultKind::kLimit;
    sample_.fault.violation = {row.axis, row.quantity, row.value, row.limit, 8, 0, MoveKind::kStroke};
    watch();
    expect(kLimits, kError, row.message, {{row.name, row.margin}});
    watch();
    expect(kLimits, kOk, "no setpoints");
  }
}

TEST_F(DiagnosticsTest, BufferThatEmptiesIsAWarningAndThenAnError) {
  const struct {
    std::uint32_t least;
    int level;
    const char *message, *fill;
  } rows[]{{25, kOk, "filled", "50"},
           {24, kWarn, "down to 24 of 50 commands", "48"},
           {10, kWarn, "down to 10 of 50 commands", "20"},
           {9, kError, "down to 9 of 50 commands", "18"},
           {49, kOk, "filled", "98"}};
  for (const auto& row : rows) {
    for (const std::uint32_t waiting : {50U, row.least, 49U}) {
      sample_.drive.commands_waiting = waiting;
      watch(2);
    }
    expect(kBuffer, row.level, row.message, {{"Minimum fill [%]", row.fill}, {"Commands waiting", "49"}});
  }
}

TEST_F(DiagnosticsTest, BufferIsReportedOfADriveThatHasOneAndUnderPower) {
  watch();
  expect(kBuffer, kOk, "the drive does not buffer");
  sample_.drive.commands_waiting = 50;
  watch();
  ask(kBuffer);
  sample_.state = MachineState::kDisabled;
  watch();
  sample_.drive.commands_waiting = 0;
  ask(kBuffer);
  watch();
  expect(kBuffer, kOk, "no power");
  // How full it was before does not count.
  sample_.state = MachineState::kReady;
  sample_.drive.commands_waiting = 20;
  watch();
  EXPECT_EQ(value(ask(kBuffer), "Minimum fill [%]"), "100");
}

TEST_F(DiagnosticsTest, WhatIsAmissWithJournalOrHistoryIsReported) {
  diagnostics_.setHistoryError("history /x: No space left on device");
  EXPECT_EQ(levelOf(kJournal), kOk);
  expect(kHistory, kWarn, "history /x: No space left on device");
  diagnostics_.setHistoryError("");
  diagnostics_.setJournalError("journal /x: No space left on device");
  EXPECT_EQ(levelOf(kHistory), kOk);
  expect(kJournal, kError, "journal /x: No space left on device");
  diagnostics_.setJournalError("");
  EXPECT_EQ(levelOf(kJournal), kOk);
}

TEST(RecorderWatch, ReportsARecorderThatHasBeenGoneForSeconds) {
  RecorderWatch watch("/a_bag");
  const auto expectLevel = [&](double time, int level) {
    watch.look(ros::SteadyTime(100) + ros::WallDuration(time));
    diagnostic_updater::DiagnosticStatusWrapper status;
    watch.report(status);
    EXPECT_EQ(static_cast<int>(status.level), level) << time;
  };
  expectLevel(0, kOk);
  watch.connect("/b_bag");
  expectLevel(4.9, kOk);
  expectLevel(5.1, kError);
  watch.connect("/a_bag");
  expectLevel(6, kOk);
  watch.disconnect("/b_bag");
  expectLevel(60, kOk);
  // One that is back at once, in either order.
  watch.connect("/a_bag");
  watch.disconnect("/a_bag");
  expectLevel(70, kOk);
  watch.disconnect("/a_bag");
  expectLevel(71, kOk);
  watch.connect("/a_bag");
  expectLevel(77, kOk);
  watch.disconnect("/a_bag");
  expectLevel(78, kOk);
  expectLevel(84, kError);
}

}  // namespace test_diagnostics
}  // namespace grinder
