#pragma once

#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/core/job_file.h"
#include "flute_grinder/core/setpoint_stream.h"
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
  config.homing_timeout = 0.0505;
  config.spindle_timeout = 0.0205;
  return config;
}

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

/// Absolute encoders, and a spindle that comes to speed with the fifth period of a millisecond.
inline SimulatedDrive::Equipment equipment() { return {true, 0.0045}; }

/// A drive whose axes are where they were told to be, whose spindle and coolant come and go at once, and which a test
/// can make say anything. It homes for as long as it is told to.
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
    status.homing = written_drive.enable && written_drive.home;
    status.spindle_at_speed = written_drive.spindle;
    status.coolant_on = written_drive.coolant;
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

#define EXPECT_CONTAINS(text, part) \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << "'" << (text) << "' does not contain '" << (part) << "'"

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
inline void setUp(SimulatedDrive& drive, const LoopConfig& config) { drive.init(driveModel(config), equipment()); }

/// A drive and its loop; every cycle's record is popped into the log.
template <typename Drive>
class Rig {
 public:
  explicit Rig(const LoopConfig& config = machineConfig(), const Wheel& wheel = {}) : config_(config) {
    setUp(drive, config);
    loop = std::make_unique<ControlLoop>(drive, config, wheel);
  }

  /// With a drive that `prepare` sets up.
  template <typename Prepare>
  Rig(const LoopConfig& config, const Prepare& prepare) : config_(config) {
    prepare(drive);
    loop = std::make_unique<ControlLoop>(drive, config);
  }

  /// @param periods that have passed since the last cycle.
  const CycleRecord& cycle(double periods = 1) {
    const ros::Duration period(periods * config_.machine.period);
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

  /// Asks for something by its own road, and runs cycles until it is answered.
  /// @param job of kStart.
  RequestReply ask(MachineEvent event, SetpointStream* job = nullptr) {
    if (event == MachineEvent::kStart) return askToStart(*job);
    if (isStop(event)) {
      const std::uint32_t ticket = loop->postAskedStop(event);
      return answerOf([&] { return loop->stopReply(event, ticket); });
    }
    EXPECT_TRUE(loop->post(event)) << "the request was not taken";
    return answerOf([&] { return loop->reply(); });
  }

  /// Asks for a start and runs cycles until it is answered.
  RequestReply askToStart(SetpointStream& job) {
    EXPECT_TRUE(loop->postStart(&job)) << "the start was not taken";
    return answerOf([&] { return loop->startReply(); });
  }

  /// Runs cycles until there is an answer.
  template <typename Poll>
  RequestReply answerOf(const Poll& poll) {
    for (int i = 0; i < 15; ++i) {
      cycle();
      if (const std::optional<RequestReply> answer = poll()) return *answer;
    }
    ADD_FAILURE() << "no answer within 15 cycles";
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

  /// Starts a job and runs until spindle and coolant let it run; the next cycle writes its first setpoint.
  void start(SetpointStream& job) {
    const RequestReply answer = askToStart(job);
    ASSERT_TRUE(answer.accepted) << answer.text;
    if (last().state != MachineState::kRunning) runUntil(MachineState::kRunning);
  }

  /// Enables and starts the paper's job.
  void startPaper() {
    enable();
    stream.emplace(paperStream());
    start(*stream);
  }

  /// Runs until a state is reached.
  void runUntil(MachineState state) {
    for (int i = 0; i < 100000; ++i) {
      if (cycle().state == state) return;
    }
    FAIL() << "never " << toString(state) << ", but " << toString(last().state);
  }

  /// Runs the job that has been started until the setpoint of a cycle.
  void runToCycle(std::uint64_t number) {
    for (int i = 0; i < 100000; ++i) {
      if (last().has_setpoint && last().setpoint.cycle == number) return;
      cycle();
    }
    FAIL() << "no cycle " << number;
  }

  /// Runs the job that has been started until its first setpoint of a kind of move.
  void runTo(MoveKind move) {
    for (int i = 0; i < 100000; ++i) {
      if (last().has_setpoint && last().setpoint.move == move) return;
      const bool moves = last().state == MachineState::kRunning || last().state == MachineState::kResuming;
      ASSERT_TRUE(moves) << toString(last().state) << ", and the job has no " << toString(move);
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

/// All setpoints of a stream until it rests; held before the setpoint of a cycle, if one is given.
inline std::vector<Setpoint> allSetpoints(SetpointStream stream, std::optional<std::uint64_t> hold_at = {}) {
  std::vector<Setpoint> all;
  Setpoint setpoint;
  do {
    if (hold_at && all.size() == *hold_at) stream.hold();
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
                      a[i].move == b[i].move && a[i].step == b[i].step && a[i].at_feed == b[i].at_feed &&
                      a[i].move_index == b[i].move_index && a[i].move_fraction == b[i].move_fraction;
    if (!same) {
      return ::testing::AssertionFailure()
             << "setpoint " << i << ": " << a[i].position.transpose() << " in " << toString(a[i].move) << " and "
             << b[i].position.transpose() << " in " << toString(b[i].move);
    }
  }
  return ::testing::AssertionSuccess();
}

/// Whether a log shows nothing but motion that the axes can make, and every setpoint of a job once and in order: no
/// step beyond the velocity limit, no bend or jerk beyond its limit over pairs - within one the odd-even steps are not
/// the path's - cycle numbers without a gap, and commands that stand where there is no setpoint.
inline ::testing::AssertionResult smooth(const std::vector<CycleRecord>& log,
                                         const AxisLimits& limits = machineConfig().machine.limits) {
  constexpr double kPeriod = 0.001;
  constexpr double kRounding = 1e-6;  // relative; far above that of positions, far below any fault
  const Axes step_limit = limits.max_velocity * kPeriod * (1 + kRounding);
  const Axes bend_limit = limits.max_acceleration * (4 * kPeriod * kPeriod) * (1 + kRounding);
  const Axes jerk_limit = limits.max_jerk * (8 * kPeriod * kPeriod * kPeriod) * (1 + kRounding) + 1e-14;
  std::uint64_t next = 0;
  std::array<Axes, 4> ends;  // of the last pairs, newest first
  ends.fill(Axes::Zero());
  for (std::size_t i = 1; i < log.size(); ++i) {
    const CycleRecord& record = log[i];
    const auto failure = [&] {
      return ::testing::AssertionFailure() << "record " << i << ", " << toString(record.state) << ", cycle "
                                           << record.setpoint.cycle << " in " << toString(record.setpoint.move) << ": ";
    };
    const bool follows = [&] {
      const auto off = [](MachineState s) { return s == MachineState::kDisabled || s == MachineState::kHoming; };
      return off(record.state) || off(log[i - 1].state);
    }();
    if (follows) continue;
    if (!record.has_setpoint) {
      if (!sameBits(record.command, log[i - 1].command)) return failure() << "the command moves without a setpoint";
      continue;
    }
    const Axes& p = record.setpoint.position;
    if (!sameBits(record.command, p)) return failure() << "the command is not the setpoint";
    const Axes step = p - log[i - 1].command;
    if (!(step.abs() <= step_limit).all()) return failure() << "a step of " << step.transpose();
    if (record.setpoint.cycle == 0) {
      next = 0;
      ends.fill(p);
    }
    if (record.setpoint.cycle != next) return failure() << "expected cycle " << next;
    if (next++ % 2 == 1) continue;
    ends = {p, ends[0], ends[1], ends[2]};
    const Axes bend = ends[0] - 2 * ends[1] + ends[2];
    const Axes jerk = ends[0] - 3 * ends[1] + 3 * ends[2] - ends[3];
    if (!(bend.abs() <= bend_limit).all()) return failure() << "a bend of " << bend.transpose();
    if (!(jerk.abs() <= jerk_limit).all()) return failure() << "a jerk of " << jerk.transpose();
  }
  return ::testing::AssertionSuccess();
}

/// Whether all records of a log from an index on show the axes at rest.
inline ::testing::AssertionResult atRestFrom(const std::vector<CycleRecord>& log, std::size_t from) {
  for (std::size_t i = from; i < log.size(); ++i) {
    if (log[i].has_setpoint) return ::testing::AssertionFailure() << "a setpoint in record " << i;
    if (!sameBits(log[i].command, log[from].command)) {
      return ::testing::AssertionFailure() << "the command moves in record " << i;
    }
  }
  return ::testing::AssertionSuccess();
}

/// Requests and cycles until the machine is in a state; where that takes a job, the paper's is in the midst of its
/// stroke.
inline void bringTo(Rig<FakeDrive>& rig, MachineState state) {
  using S = MachineState;
  using E = MachineEvent;
  rig.cycle();
  if (state == S::kDisabled) return;
  if (state == S::kReady) return rig.enable();
  if (state == S::kHoming) {
    rig.enable();
    ASSERT_TRUE(rig.ask(E::kHome).accepted);
  } else if (state == S::kStarting) {
    rig.enable();
    rig.drive.on_read = [](FakeDrive& d) { d.status.spindle_at_speed = false; };
    rig.stream.emplace(rig.paperStream());
    ASSERT_TRUE(rig.askToStart(*rig.stream).accepted);
  } else {
    ASSERT_NO_FATAL_FAILURE(rig.startPaper());
    ASSERT_NO_FATAL_FAILURE(rig.runTo(MoveKind::kStroke));
    rig.run(1000);
    const auto ask = [&](E event) {
      const RequestReply answer = rig.ask(event);
      ASSERT_TRUE(answer.accepted) << answer.text;
    };
    if (state == S::kCanceling) {
      ask(E::kCancel);
    } else if (state == S::kFault) {
      rig.drive.on_read = [](FakeDrive& d) { d.status.fault = true; };
      rig.cycle();
      rig.drive.on_read = [](FakeDrive& d) { d.status.fault = false; };
      rig.cycle();
    } else if (state == S::kLifting) {
      rig.drive.on_read = [](FakeDrive& d) { d.status.fault = true; };
      rig.cycle();
      rig.drive.on_read = nullptr;
      rig.drive.status.fault = false;
      rig.cycle();
      ask(E::kReset);
      ask(E::kEnable);
      ask(E::kLift);
      rig.run(30);
    } else if (state != S::kRunning) {
      ask(E::kHold);
      if (state != S::kHolding) rig.runUntil(S::kHeld);
      if (state == S::kRetracting || state == S::kRetracted || state == S::kResuming) ask(E::kRetract);
      if (state == S::kRetracted || state == S::kResuming) rig.runUntil(S::kRetracted);
      if (state == S::kResuming) ask(E::kResume);
    }
  }
  ASSERT_EQ(rig.last().state, state) << toString(rig.last().state);
}

}  // namespace flute_grinder::testing
