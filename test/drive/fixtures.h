#pragma once

#include "flute_grinder/core/job_file.h"
#include "flute_grinder/core/setpoint_stream.h"
#include "flute_grinder/drive/control_loop.h"
#include "flute_grinder/drive/simulated_drive.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// A machine, two drives and a rig that runs the control loop cycle by cycle, without its thread and without ROS.
namespace flute_grinder::testing {

/// The machine of config/grinder.yaml and urdf/grinder.urdf, its figures written out.
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
  config.homing_timeout = 1;
  config.spindle_timeout = 1;
  return config;
}

inline SimulatedDrive::Model driveModel(const LoopConfig& config = machineConfig()) {
  SimulatedDrive::Model model;
  for (std::size_t i = 0; i < model.size(); ++i) {
    model[i].time_constant = 0.002;
    model[i].counts_per_unit = i == kA ? 1e6 : 1e7;
    model[i].start_position = config.machine.park[static_cast<int>(i)];
  }
  return model;
}

/// A drive whose axes are where they were told to be, and which a test can make say anything.
class FakeDrive : public RobotHW {
 public:
  FakeDrive() {
    status.homed = true;
    for (std::size_t i = 0; i < position.size(); ++i) {
      const JointStateHandle state(kJointNames[i], &position[i], &velocity[i], &effort[i]);
      joint_states_.registerHandle(state);
      joint_commands_.registerHandle(JointHandle(state, &command[i]));
    }
    drive_.registerHandle(DriveHandle("drive", &status, &drive_command));
    registerInterface(&joint_states_);
    registerInterface(&joint_commands_);
    registerInterface(&drive_);
  }

  bool init(ros::NodeHandle&, ros::NodeHandle&) override { return true; }

  void read(const ros::Time&, const ros::Duration&) override {
    if (written_drive.enable && status.enabled) position = written;
    status.enabled = written_drive.enable;
    ++status.feedback_count;
    if (on_read) on_read(*this);
  }

  void write(const ros::Time&, const ros::Duration&) override {
    written = command;
    written_drive = drive_command;
  }

  void place(const Axes& at) { std::copy(at.data(), at.data() + kAxisCount, position.begin()); }

  DriveStatus status;
  std::array<double, kAxisCount> position{}, velocity{}, effort{}, command{};
  DriveCommand drive_command;
  std::function<void(FakeDrive&)> on_read;  ///< has the last word on what is read

  std::array<double, kAxisCount> written{};  ///< as of the last write()
  DriveCommand written_drive;

 private:
  JointStateInterface joint_states_;
  PositionJointInterface joint_commands_;
  DriveInterface drive_;
};

inline Axes toAxes(const std::array<double, kAxisCount>& values) {
  Axes axes;
  std::copy(values.begin(), values.end(), axes.data());
  return axes;
}

/// Every bit the same, so that -0 is not 0 and nan is itself.
inline bool sameBits(const Axes& a, const Axes& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * kAxisCount) == 0;
}

inline void setUp(FakeDrive& drive, const LoopConfig& config) { drive.place(config.machine.park); }
inline void setUp(SimulatedDrive& drive, const LoopConfig& config) { drive.init(driveModel(config), {}); }

/// A drive and its loop; every cycle's record is popped into the log.
template <typename Drive>
class Rig {
 public:
  explicit Rig(const LoopConfig& config = machineConfig()) : config_(config) {
    setUp(drive, config);
    loop = std::make_unique<ControlLoop>(drive, config);
  }

  const CycleRecord& cycle() {
    const ros::Duration period(config_.machine.period);
    time_ += period;
    loop->cycle(time_, period);
    CycleRecord record;
    if (!loop->pop(record)) ADD_FAILURE() << "a cycle left no record";
    log.push_back(record);
    return log.back();
  }

  const CycleRecord& run(int cycles) {
    for (int i = 0; i < cycles; ++i) cycle();
    return log.back();
  }

  /// Posts a request and runs cycles until it is answered.
  RequestReply ask(MachineEvent event, SetpointStream* stream = nullptr) {
    if (!loop->post(event, stream)) {
      ADD_FAILURE() << "the request was not taken";
      return {};
    }
    for (int i = 0; i < 10; ++i) {
      cycle();
      if (auto answer = loop->reply()) return *answer;
    }
    ADD_FAILURE() << "no answer within 10 cycles";
    return {};
  }

  void enable() {
    const RequestReply answer = ask(MachineEvent::kEnable);
    ASSERT_TRUE(answer.accepted) << answer.text;
  }

  /// The paper's job from where the axes are told to be; the machine may be another than the loop's.
  SetpointStream paperStream(const Machine& machine) const {
    static const GrindJob job = readJobFile(SOURCE_DIR "/jobs/paper.yaml");
    return SetpointStream(GrindProgram(job, machine, last().command));
  }
  SetpointStream paperStream() const { return paperStream(config_.machine); }

  /// Enables and starts the paper's job.
  void startPaper() {
    enable();
    stream.emplace(paperStream());
    const RequestReply answer = ask(MachineEvent::kStart, &*stream);
    ASSERT_TRUE(answer.accepted) << answer.text;
  }

  /// Runs the job that has been started until its first setpoint of a kind of move.
  void runTo(MoveKind move) {
    for (int i = 0; i < 100000; ++i) {
      if (last().has_setpoint && last().setpoint.move == move) return;
      ASSERT_EQ(last().state, MachineState::kRunning) << "the job has no " << toString(move);
      cycle();
    }
    FAIL() << "no " << toString(move);
  }

  /// Runs until the job has ended.
  void runToEnd() {
    for (int i = 0; i < 100000; ++i) {
      if (cycle().job_ended) return;
    }
    FAIL() << "the job does not end";
  }

  const CycleRecord& last() const { return log.back(); }

  int jobsEnded() const {
    int count = 0;
    for (const CycleRecord& record : log) count += record.job_ended;
    return count;
  }

  std::vector<Setpoint> setpoints() const {
    std::vector<Setpoint> all;
    for (const CycleRecord& record : log) {
      if (record.has_setpoint) all.push_back(record.setpoint);
    }
    return all;
  }

  Drive drive;
  std::unique_ptr<ControlLoop> loop;
  std::vector<CycleRecord> log;
  std::optional<SetpointStream> stream;

 private:
  LoopConfig config_;
  ros::Time time_{1000};
};

/// All setpoints of a stream; stopped before the setpoint of a cycle, if one is given.
inline std::vector<Setpoint> allSetpoints(SetpointStream stream, std::optional<std::uint64_t> stop_at = {}) {
  std::vector<Setpoint> all;
  Setpoint setpoint;
  do {
    if (stop_at && all.size() == *stop_at) stream.hold();
    if (!stream.next(setpoint)) return all;
    all.push_back(setpoint);
  } while (all.size() < 1000000);
  ADD_FAILURE() << "the stream does not end";
  return all;
}

/// The first setpoint in which two rows differ, if there is one.
inline ::testing::AssertionResult sameSetpoints(const std::vector<Setpoint>& a, const std::vector<Setpoint>& b) {
  if (a.size() != b.size()) return ::testing::AssertionFailure() << a.size() << " and " << b.size() << " setpoints";
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool same = a[i].cycle == b[i].cycle && sameBits(a[i].position, b[i].position) &&
                      sameBits(a[i].velocity, b[i].velocity) && a[i].path_error == b[i].path_error &&
                      a[i].feed == b[i].feed && a[i].tooth == b[i].tooth && a[i].pass == b[i].pass &&
                      a[i].move == b[i].move && a[i].step == b[i].step && a[i].at_feed == b[i].at_feed;
    if (!same) {
      return ::testing::AssertionFailure()
             << "setpoint " << i << ": " << a[i].position.transpose() << " in " << toString(a[i].move) << " and "
             << b[i].position.transpose() << " in " << toString(b[i].move);
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace flute_grinder::testing
