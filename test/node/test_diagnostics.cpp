#include "node/diagnostics.h"

#include "control/fixtures.h"
#include "node/recorder_watch.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cmath>
#include <limits>

namespace grinder {
namespace test_diagnostics {

using diagnostic_msgs::DiagnosticStatus;
using Report = void (Diagnostics::*)(Diagnostics::Status&);

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

  /// Asks, and expects this answer.
  Diagnostics::Status expect(Report report, int level, const std::string& message) {
    const Diagnostics::Status status = ask(report);
    EXPECT_EQ(status.level, level) << status.message;
    EXPECT_EQ(status.message, message);
    return status;
  }

  static std::string value(const Diagnostics::Status& status, const std::string& key) {
    for (const auto& item : status.values) {
      if (item.key == key) return item.value;
    }
    return "no " + key;
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
  expect(&Diagnostics::reportLoop, DiagnosticStatus::ERROR, "not running");
  watch(10);
  EXPECT_EQ(ask(&Diagnostics::reportLoop).level, DiagnosticStatus::OK);
  EXPECT_EQ(ask(&Diagnostics::reportLoop).level, DiagnosticStatus::ERROR);
}

TEST_F(DiagnosticsTest, LoopReportsItsPeriods) {
  watch(3);
  sample_.period = 0.0012;
  watch();
  const auto status = expect(&Diagnostics::reportLoop, DiagnosticStatus::OK, "running");
  EXPECT_EQ(value(status, "State"), "ready");
  EXPECT_EQ(value(status, "Nominal period [s]"), "0.001");
  EXPECT_EQ(value(status, "Mean period [s]"), "0.00105");
  EXPECT_EQ(value(status, "Longest period [s]"), "0.0012");
  EXPECT_EQ(value(status, "Late cycles"), "0");
  EXPECT_EQ(value(status, "Cycles"), "4");
}

TEST_F(DiagnosticsTest, LoopReportsItsCyclesDurationsAndItsWakeUpsDelays) {
  const auto seconds = [&](const Diagnostics::Status& status, const std::string& key) {
    return std::stod(value(status, key));
  };
  sample_.busy = 2e-6;
  watch(60);
  sample_.busy = 5e-6;
  sample_.period = 0.00103;
  watch(39);
  sample_.busy = 70e-6;
  sample_.period = 0.0012;
  watch();
  auto status = ask(&Diagnostics::reportLoop);
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << status.message;
  // Quantiles are reported to 4.4 %.
  EXPECT_NEAR(seconds(status, "Median cycle duration [s]"), 2e-6, 0.1e-6);
  EXPECT_NEAR(seconds(status, "99 % cycle duration [s]"), 5e-6, 0.25e-6);
  EXPECT_EQ(value(status, "Longest cycle duration [s]"), "7e-05");
  EXPECT_EQ(value(status, "Median wake-up delay [s]"), "0");
  EXPECT_NEAR(seconds(status, "99 % wake-up delay [s]"), 30e-6, 1.5e-6);
  EXPECT_EQ(value(status, "Longest wake-up delay [s]"), "0.0002");

  sample_.busy = 1e-6;
  sample_.period = 0.0009;
  watch();
  status = ask(&Diagnostics::reportLoop);
  EXPECT_EQ(value(status, "Longest cycle duration [s]"), "1e-06");
  EXPECT_EQ(value(status, "Longest wake-up delay [s]"), "0");
}

TEST_F(DiagnosticsTest, LateCyclesAreAWarningAndThenAnError) {
  const auto late = [&](int of_hundred) {
    sample_.period = 0.0016;
    watch(of_hundred);
    sample_.period = 0.0015;  // not late yet
    watch(100 - of_hundred);
    return ask(&Diagnostics::reportLoop);
  };
  EXPECT_EQ(late(1).level, DiagnosticStatus::OK);
  const auto warning = late(2);
  EXPECT_EQ(warning.level, DiagnosticStatus::WARN);
  EXPECT_EQ(warning.message, "2 of 100 cycles were late");
  EXPECT_EQ(late(25).level, DiagnosticStatus::WARN);
  EXPECT_EQ(late(26).level, DiagnosticStatus::ERROR);
  EXPECT_EQ(late(0).level, DiagnosticStatus::OK);
}

TEST_F(DiagnosticsTest, SchedulingThatWasNotGrantedIsAWarning) {
  scheduling_ = {false, true};
  watch();
  expect(&Diagnostics::reportLoop, DiagnosticStatus::WARN, "no real-time scheduling");
  scheduling_ = {true, false};
  watch();
  const auto status = expect(&Diagnostics::reportLoop, DiagnosticStatus::WARN, "memory is not locked");
  EXPECT_EQ(value(status, "Memory locked"), "False");
}

TEST_F(DiagnosticsTest, RecordsLostAreAnErrorOnce) {
  sample_.samples_lost = 7;
  watch();
  expect(&Diagnostics::reportLoop, DiagnosticStatus::ERROR, "7 cycle samples were lost");
  watch();
  const auto next = ask(&Diagnostics::reportLoop);
  EXPECT_EQ(next.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(next, "Samples lost"), "7");
}

TEST_F(DiagnosticsTest, DriveIsOkWhenHomedAndItsInterlocksAreClosed) {
  watch();
  expect(&Diagnostics::reportDrive, DiagnosticStatus::OK, "enabled");
  sample_.drive.enabled = false;
  watch();
  const auto status = expect(&Diagnostics::reportDrive, DiagnosticStatus::OK, "disabled");
  EXPECT_EQ(value(status, "Enabled"), "False");
  sample_.power_stays = true;
  watch();
  expect(&Diagnostics::reportDrive, DiagnosticStatus::ERROR,
         "the drive still reports power, though it was switched off");
  sample_.power_stays = false;
  sample_.drive.homed = false;
  watch();
  expect(&Diagnostics::reportDrive, DiagnosticStatus::WARN, "not homed");
  sample_.drive.homed = true;
  sample_.interlock = Interlock::kCoolant;
  watch();
  expect(&Diagnostics::reportDrive, DiagnosticStatus::WARN, "no coolant flows");
}

TEST_F(DiagnosticsTest, OneCycleOfEmergencyStopIsNotMissed) {
  sample_.drive.emergency_stop = true;
  watch();
  sample_.drive.emergency_stop = false;
  watch(100);
  const auto status = expect(&Diagnostics::reportDrive, DiagnosticStatus::ERROR, "emergency stop");
  EXPECT_EQ(value(status, "Emergency stop"), "True");
  watch();
  EXPECT_EQ(ask(&Diagnostics::reportDrive).level, DiagnosticStatus::OK);
}

TEST_F(DiagnosticsTest, FaultIsReportedOnceAndWithAllElse) {
  sample_.state = MachineState::kFault;
  sample_.fault.kind = FaultKind::kEmergencyStop;
  sample_.drive.emergency_stop = sample_.drive.fault = true;
  sample_.drive.homed = false;
  watch();
  expect(&Diagnostics::reportDrive, DiagnosticStatus::ERROR, "emergency stop; the drive reports a fault; not homed");
}

TEST_F(DiagnosticsTest, FeedbackAgeIsTheLongest) {
  watch();
  watchStale();
  watchStale();
  watch();
  auto status = ask(&Diagnostics::reportDrive);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);  // 2 ms of 2.5 ms
  EXPECT_EQ(value(status, "Longest feedback age [s]"), "0.002");
  EXPECT_EQ(value(status, "Allowed feedback age [s]"), "0.0025");
  for (int i = 0; i < 3; ++i) watchStale();
  expect(&Diagnostics::reportDrive, DiagnosticStatus::ERROR, "no fresh positions for 0.003 s");
}

TEST_F(DiagnosticsTest, PositionThatIsNoNumberIsAnError) {
  sample_.position[kZ] = kNan;
  watch();
  sample_.position[kZ] = 0;
  watch();
  expect(&Diagnostics::reportDrive, DiagnosticStatus::ERROR, "axis_z position is nan");
  const auto following = ask(&Diagnostics::reportFollowing);
  EXPECT_EQ(following.level, DiagnosticStatus::ERROR);
  EXPECT_EQ(value(following, "axis_z max [m]"), "nan");
}

TEST_F(DiagnosticsTest, FollowingErrorIsTheMaxOfEachAxis) {
  sample_.command_in_effect << 0.1, 0, 0, 3;
  sample_.position << 0.1004, 0, 0, 3;
  watch();
  sample_.position << 0.1, 0.0002, 0, 2.975;
  watch();
  const auto status = ask(&Diagnostics::reportFollowing);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(status, "axis_x max [m]"), "0.0004");
  EXPECT_EQ(value(status, "axis_x of the allowed [%]"), "40");
  EXPECT_EQ(value(status, "axis_y of the allowed [%]"), "20");
  EXPECT_EQ(value(status, "axis_z of the allowed [%]"), "0");
  EXPECT_EQ(value(status, "axis_a max [rad]"), "0.025");
}

TEST_F(DiagnosticsTest, FollowingErrorIsAWarningAndThenAnError) {
  sample_.position << 0, 0.0006, 0, 0;
  watch();
  expect(&Diagnostics::reportFollowing, DiagnosticStatus::WARN, "axis_y 0.0006 m of 0.001 m");
  sample_.position << 0, 0.0006, 0, -0.046;
  watch();
  expect(&Diagnostics::reportFollowing, DiagnosticStatus::ERROR,
         "axis_y 0.0006 m of 0.001 m; axis_a 0.046 rad of 0.05 rad");
  sample_.position.setZero();
  watch();
  EXPECT_EQ(ask(&Diagnostics::reportFollowing).level, DiagnosticStatus::OK);
}

TEST_F(DiagnosticsTest, FollowingErrorCountsInTheCycleOfTheFaultAndNotAfter) {
  watch();
  sample_.state = MachineState::kFault;
  sample_.position[kX] = 0.002;
  watch();
  EXPECT_EQ(ask(&Diagnostics::reportFollowing).level, DiagnosticStatus::ERROR);
  watch();
  EXPECT_EQ(ask(&Diagnostics::reportFollowing).level, DiagnosticStatus::OK);
  sample_.state = MachineState::kDisabled;
  watch();
  EXPECT_EQ(ask(&Diagnostics::reportFollowing).level, DiagnosticStatus::OK);
}

TEST_F(DiagnosticsTest, MarginOfPositionIsTheNearerLimits) {
  // X from -0.1 to 0.3: 0.05 of half a range of 0.2 are left; Y from -0.02 to 0.15: 0.015 of 0.085.
  write({-0.05, 0.135, 0.025, 0});
  const auto status = ask(&Diagnostics::reportLimits);
  EXPECT_EQ(value(status, "axis_x position margin [%]"), "25");
  EXPECT_NEAR(std::stod(value(status, "axis_y position margin [%]")), 100 * 0.015 / 0.085, 1e-4);
  EXPECT_EQ(value(status, "axis_z position margin [%]"), "100");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "axis_y position at 82.3529 % of its limit");
}

TEST_F(DiagnosticsTest, MarginOfMotionIsThatOfThePositionsWritten) {
  // At 1 kHz: 0.15 of 0.2 m/s, and half of A's 12.566 rad/s; at 2 ms: 0.2 m/s^2 of 0.5, over it 5 m/s^3 of 10.
  write({0.1, 0.065, 0.025, 0});
  for (int i = 1; i <= 40; ++i) write({0.1 + 0.00015 * i, 0.065, 0.025, 0.006283 * i});
  ask(&Diagnostics::reportLimits);
  for (int i = 41; i <= 60; ++i) write({0.1 + 0.00015 * i, 0.065, 0.025, 0.006283 * i});
  const auto even = ask(&Diagnostics::reportLimits);
  EXPECT_EQ(even.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(even, "Setpoints"), "20");
  EXPECT_NEAR(std::stod(value(even, "axis_x velocity margin [%]")), 25, 1e-3);
  EXPECT_NEAR(std::stod(value(even, "axis_a velocity margin [%]")), 50, 1e-3);
  EXPECT_NEAR(std::stod(value(even, "axis_x acceleration margin [%]")), 100, 1e-3);
  EXPECT_NEAR(std::stod(value(even, "axis_y velocity margin [%]")), 100, 1e-9);

  // Half a cycle pair's worth of 0.2 m/s^2 more.
  const double x = 0.1 + 0.00015 * 60;
  write({x + 0.00015 + 0.0000004, 0.065, 0.025, 0.006283 * 61});
  write({x + 0.0003 + 0.0000008, 0.065, 0.025, 0.006283 * 62});
  const auto bent = ask(&Diagnostics::reportLimits);
  EXPECT_NEAR(std::stod(value(bent, "axis_x acceleration margin [%]")), 100 - 100 * 0.2 / 0.5, 1e-2);
  // From none to 0.2 m/s^2 in 2 ms are 100 m/s^3.
  EXPECT_NEAR(std::stod(value(bent, "axis_x jerk margin [%]")), 100 - 100 * 100 / 10, 1);
  EXPECT_EQ(bent.level, DiagnosticStatus::ERROR);
  EXPECT_CONTAINS(bent.message, "axis_x jerk at 1000 % of its limit");
}

TEST_F(DiagnosticsTest, UseOfALimitIsAWarning) {
  write({0.1, 0.065, 0.025, 0});
  write({0.1, 0.065 + 0.00009, 0.025, 0});
  expect(&Diagnostics::reportLimits, DiagnosticStatus::WARN, "axis_y velocity at 90 % of its limit");
}

TEST_F(DiagnosticsTest, SetpointsAfterAGapAreNotComparedWithThoseBefore) {
  write({0.1, 0.065, 0.025, 0});
  ask(&Diagnostics::reportLimits);
  next_cycle_ = 1001;
  for (int i = 0; i < 30; ++i) write({0.2 + 0.00015 * i, 0.065, 0.025, 0});
  const auto status = ask(&Diagnostics::reportLimits);
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << status.message;
  EXPECT_NEAR(std::stod(value(status, "axis_x velocity margin [%]")), 25, 1e-3);
  EXPECT_NEAR(std::stod(value(status, "axis_x jerk margin [%]")), 100, 1e-3);
}

TEST_F(DiagnosticsTest, NextJobBeginsAfresh) {
  write({0.1, 0.065, 0.025, 0});
  next_cycle_ = 0;
  write({0.2, 0.065, 0.025, 0});
  const auto status = ask(&Diagnostics::reportLimits);
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << status.message;
  EXPECT_EQ(value(status, "axis_x velocity margin [%]"), "100");
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
    EXPECT_EQ(value(expect(&Diagnostics::reportLimits, DiagnosticStatus::ERROR, row.message), row.name), row.margin);
    watch();
    expect(&Diagnostics::reportLimits, DiagnosticStatus::OK, "no setpoints");
  }
}

TEST_F(DiagnosticsTest, BufferThatEmptiesIsAWarningAndThenAnError) {
  const auto min = [&](std::uint32_t commands) {
    sample_.drive.commands_waiting = 50;
    watch(3);
    sample_.drive.commands_waiting = commands;
    watch();
    sample_.drive.commands_waiting = 49;
    watch(3);
    return ask(&Diagnostics::reportBuffer);
  };
  const auto good = min(25);
  EXPECT_EQ(good.level, DiagnosticStatus::OK);
  EXPECT_EQ(good.message, "filled");
  EXPECT_EQ(value(good, "Minimum fill [%]"), "50");
  EXPECT_EQ(value(good, "Commands waiting"), "49");
  const auto warning = min(24);
  EXPECT_EQ(warning.level, DiagnosticStatus::WARN);
  EXPECT_EQ(warning.message, "down to 24 of 50 commands");
  EXPECT_EQ(min(10).level, DiagnosticStatus::WARN);
  EXPECT_EQ(min(9).level, DiagnosticStatus::ERROR);
  EXPECT_EQ(min(49).level, DiagnosticStatus::OK);
}

TEST_F(DiagnosticsTest, BufferIsReportedOfADriveThatHasOneAndUnderPower) {
  watch();
  expect(&Diagnostics::reportBuffer, DiagnosticStatus::OK, "the drive does not buffer");
  sample_.drive.commands_waiting = 50;
  watch();
  ask(&Diagnostics::reportBuffer);
  sample_.state = MachineState::kDisabled;
  watch();
  sample_.drive.commands_waiting = 0;
  ask(&Diagnostics::reportBuffer);
  watch();
  expect(&Diagnostics::reportBuffer, DiagnosticStatus::OK, "no power");
  // How full it was before does not count.
  sample_.state = MachineState::kReady;
  sample_.drive.commands_waiting = 20;
  watch();
  EXPECT_EQ(value(ask(&Diagnostics::reportBuffer), "Minimum fill [%]"), "100");
}

TEST_F(DiagnosticsTest, UnderrunIsAnErrorOnce) {
  sample_.drive.commands_waiting = 50;
  sample_.drive.underruns = 3;
  watch();
  expect(&Diagnostics::reportBuffer, DiagnosticStatus::ERROR, "3 underruns");
  watch();
  const auto next = ask(&Diagnostics::reportBuffer);
  EXPECT_EQ(next.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(next, "Underruns"), "3");
}

TEST_F(DiagnosticsTest, WhatIsAmissWithJournalOrHistoryIsReported) {
  diagnostics_.setHistoryError("history /x: No space left on device");
  EXPECT_EQ(ask(&Diagnostics::reportJournal).level, DiagnosticStatus::OK);
  expect(&Diagnostics::reportHistory, DiagnosticStatus::WARN, "history /x: No space left on device");
  diagnostics_.setHistoryError("");
  diagnostics_.setJournalError("journal /x: No space left on device");
  EXPECT_EQ(ask(&Diagnostics::reportHistory).level, DiagnosticStatus::OK);
  expect(&Diagnostics::reportJournal, DiagnosticStatus::ERROR, "journal /x: No space left on device");
  diagnostics_.setJournalError("");
  EXPECT_EQ(ask(&Diagnostics::reportJournal).level, DiagnosticStatus::OK);
}

TEST(RecorderWatch, ReportsARecorderThatHasBeenGoneForSeconds) {
  RecorderWatch watch("/a_bag");
  const ros::SteadyTime start(100);
  const auto level = [&](double time) {
    watch.look(start + ros::WallDuration(time));
    diagnostic_updater::DiagnosticStatusWrapper status;
    watch.report(status);
    return static_cast<int>(status.level);
  };
  EXPECT_EQ(level(0), DiagnosticStatus::OK);
  watch.connect("/b_bag");
  EXPECT_EQ(level(4.9), DiagnosticStatus::OK);
  EXPECT_EQ(level(5.1), DiagnosticStatus::ERROR);
  watch.connect("/a_bag");
  EXPECT_EQ(level(6), DiagnosticStatus::OK);
  watch.disconnect("/b_bag");
  EXPECT_EQ(level(60), DiagnosticStatus::OK);
  // One that is back at once, in either order.
  watch.connect("/a_bag");
  watch.disconnect("/a_bag");
  EXPECT_EQ(level(70), DiagnosticStatus::OK);
  watch.disconnect("/a_bag");
  EXPECT_EQ(level(71), DiagnosticStatus::OK);
  watch.connect("/a_bag");
  EXPECT_EQ(level(77), DiagnosticStatus::OK);
  watch.disconnect("/a_bag");
  EXPECT_EQ(level(78), DiagnosticStatus::OK);
  EXPECT_EQ(level(84), DiagnosticStatus::ERROR);
}

}  // namespace test_diagnostics
}  // namespace grinder
