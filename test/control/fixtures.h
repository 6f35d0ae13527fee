#pragma once

#include "control/heap.h"
#include "drive/simulated_drive.h"
#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/drive/drive.h"
#include "flute_grinder/machine/machine_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>
#include <optional>
#include <string>

// A machine and two drives for the tests of the control loop.
namespace grinder::test_support {

using S = MachineState;
using E = MachineEvent;

/// The machine of config/grinder.yaml and urdf/grinder.urdf, its values written out.
inline LoopConfig machineConfig() {
  LoopConfig config;
  AxisLimits& limits = config.machine.limits;
  limits.min_position << -0.1, -0.02, -0.05, -125.663706;
  limits.max_position << 0.3, 0.15, 0.1, 125.663706;
  limits.max_velocity << 0.2, 0.1, 0.1, 12.566;
  limits.max_acceleration << 0.5, 0.5, 0.5, 62.83;
  limits.max_jerk << 10, 10, 10, 1257;
  config.machine.period = 0.001;
  config.machine.park << -0.05, 0.05, 0, 0;
  config.following_error << 0.001, 0.001, 0.001, 0.05;
  config.feedback_timeout = 0.0025;
  config.enable_timeout = 0.0105;
  config.homing_timeout = 0.0505;
  config.spindle_timeout = 0.0205;
  config.jog_timeout = 0.0505;
  config.jog_velocity << 0.01, 0.01, 0.01, 0.5;
  return config;
}

/// The swivel of test/jobs/paper.yaml [rad].
constexpr double kPaperSwivel = 31.769 * 3.14159265358979323846 / 180;

inline SimulatedDrive::Model driveModel(const LoopConfig& config = machineConfig()) {
  SimulatedDrive::Model model;
  for (std::size_t i = 0; i < model.size(); ++i) {
    model[i].time_constant = 0.002;
    model[i].counts_per_unit = i == kA ? 1e6 : 1e7;
    model[i].start_position = model[i].home_position = config.machine.park[static_cast<int>(i)];
    model[i].homing_velocity = i == kA ? 200 : 5;
  }
  return model;
}

/// Absolute encoders, and a spindle that reaches its speed in the fifth period of a millisecond.
inline SimulatedDrive::Equipment equipment() { return {true, 0.0045}; }

/// A drive whose axes, spindle and coolant reach every command at once, and with which a test can simulate any reading.
/// It homes for as long as it is commanded to.
class FakeDrive : public Drive {
 public:
  FakeDrive() {
    status.homed = true;
    can.homing = can.spindle = can.coolant = can.probe = true;
  }

  void init(ros::NodeHandle&, ros::NodeHandle&) override {}
  DriveCapabilities capabilities() const override { return can; }

  void read(const DriveCycle&, DriveFeedback& feedback) override {
    if (written_drive.enable && status.enabled) position = written;
    status.enabled = written_drive.enable;
    status.homing = written_drive.enable && written_drive.home;
    status.spindle_at_speed = written_drive.spindle;
    status.coolant_on = written_drive.coolant;
    ++status.feedback_count;
    call([this] {
      if (on_read) on_read(*this);
    });
    feedback = {position, velocity, status};
  }

  void write(const DriveCycle&, const DriveCommand& command) override {
    ++writes;
    call([this] {
      if (on_write) on_write();
    });
    written = command.position;
    written_drive = command;
  }

  ros::Duration wait(const ros::Duration& nominal) override {
    if (!on_wait) return Drive::wait(nominal);
    on_wait();
    return waited ? *waited : sinceLastCycle(nominal);
  }

  void prepare() override {
    if (on_prepare) on_prepare();
  }

  bool powerOff() override {
    power_off = true;
    if (on_power_off) on_power_off();
    if (power_off_fails) throw std::runtime_error("no bus");
    return true;
  }

  void place(const Axes& at) { std::copy(at.data(), at.data() + kAxisCount, position.begin()); }

  DriveCapabilities can;
  DriveStatus status;
  AxisValues position{};
  AxisValues velocity{};
  std::function<void(FakeDrive&)> on_read;  ///< has the last word on what is read
  std::function<void()> on_write;           ///< before what is written takes effect
  std::function<void()> on_prepare;
  std::function<void()> on_power_off;
  std::function<void()> on_wait;        ///< in place of the wait
  std::optional<ros::Duration> waited;  ///< what that returns, in place of the time since the last cycle

  int writes = 0;
  std::atomic<bool> power_off{false};  ///< by powerOff()
  std::atomic<bool> power_off_fails{false};
  AxisValues written{};  ///< as of the last write()
  DriveCommand written_drive;

 private:
  template <typename Call>
  static void call(const Call& of_the_test) {
    const HeapNotCounted here;
    try {
      of_the_test();
    } catch (...) {
      heap_holds_exception = true;
      throw;
    }
  }
};

#define EXPECT_CONTAINS(text, part) \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << "'" << (text) << "' does not contain '" << (part) << "'"

inline Axes toAxes(const std::array<double, kAxisCount>& values) {
  Axes axes;
  std::copy(values.begin(), values.end(), axes.data());
  return axes;
}

/// Whether every bit is the same: -0 differs from 0, and nan equals itself.
inline bool sameBits(const Axes& a, const Axes& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * kAxisCount) == 0;
}

inline void setUp(FakeDrive& drive, const LoopConfig& config) { drive.place(config.machine.park); }
inline void setUp(SimulatedDrive& drive, const LoopConfig& config) { drive.init(driveModel(config), equipment()); }

}  // namespace grinder::test_support
