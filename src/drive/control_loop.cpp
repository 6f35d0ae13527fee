#include "flute_grinder/drive/control_loop.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

namespace flute_grinder {

namespace {

using Clock = std::chrono::steady_clock;

/// Above every ordinary thread, below the kernel's own.
constexpr int kRealtimePriority = 80;

/// How long a request waits for the loop beyond what it may take by itself.
constexpr double kAnswerTimeout = 2;

/// Locks the process in memory where that has no limit: with one, memory could run out later, in the midst of a job.
bool lockMemory() {
  rlimit limit{};
  const bool unlimited = geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
  return unlimited && mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
}

template <typename Interface>
Interface& require(RobotHW& hw, const char* name) {
  auto* interface = hw.get<Interface>();
  if (!interface) throw HardwareInterfaceException(std::string("the drive offers no ") + name);
  return *interface;
}

}  // namespace

const char* toString(Interlock interlock) noexcept {
  switch (interlock) {
    case Interlock::kNone: return "";
    case Interlock::kNotHomed: return "the axes are not homed";
    case Interlock::kSpindle: return "the spindle is not at speed";
    case Interlock::kCoolant: return "no coolant flows";
    case Interlock::kProbe: return "the measuring probe is in the way";
  }
  return "unknown";
}

std::string LoopFault::text() const {
  const std::string unit = std::string(" ") + axisUnit(axis);
  const char* joint = kJointNames[static_cast<std::size_t>(axis)];
  std::ostringstream text;
  switch (kind) {
    case FaultKind::kNone: break;
    case FaultKind::kEmergencyStop: text << "emergency stop"; break;
    case FaultKind::kDriveFault: text << "the drive reports a fault"; break;
    case FaultKind::kPowerLost: text << "the drive has switched its power off"; break;
    case FaultKind::kStaleFeedback:
      text << "no fresh positions from the drive for " << value << " s, allowed " << limit << " s";
      break;
    case FaultKind::kInvalidFeedback: text << joint << " position from the drive is " << value; break;
    case FaultKind::kFollowingError:
      text << joint << " following error " << value << unit << " is beyond its limit " << limit << unit;
      break;
    case FaultKind::kUnderrun:
      text << "the axes found no setpoint in " << value << " servo cycles, after setpoint " << cycle;
      break;
    case FaultKind::kLimit: text << violation.text(); break;
    case FaultKind::kHoming:
      text << "the drive has not found its reference after " << value << " s, allowed " << limit << " s";
      break;
    case FaultKind::kInterlock:
      text << toString(interlock) << ' ' << value << " s after the job was started, allowed " << limit << " s";
      break;
  }
  return text.str();
}

ControlLoop::ControlLoop(RobotHW& hw, const LoopConfig& config)
    : hw_(hw), config_(config), limit_check_(config.machine.limits, config.machine.period) {
  require<JointStateInterface>(hw, "JointStateInterface");
  auto& joints = require<PositionJointInterface>(hw, "PositionJointInterface");
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i] = joints.getHandle(kJointNames[i]);
  drive_ = require<DriveInterface>(hw, "DriveInterface").getHandle("drive");
}

ControlLoop::~ControlLoop() { stop(); }

void ControlLoop::start() {
  running_ = true;
  memory_locked_ = lockMemory();
  thread_ = std::thread([this] { run(); });
}

void ControlLoop::stop() {
  if (!thread_.joinable()) return;
  running_ = false;
  thread_.join();
}

void ControlLoop::run() {
  sched_param parameters{};
  parameters.sched_priority = kRealtimePriority;
  realtime_scheduling_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;

  const ros::Duration nominal(config_.machine.period);
  const ros::Time start_time = ros::Time::now();
  const Clock::time_point start = Clock::now();
  Clock::time_point last = start;
  const auto nanoseconds = [](Clock::duration d) {
    return ros::Duration().fromNSec(std::chrono::duration_cast<std::chrono::nanoseconds>(d).count());
  };
  while (running_) {
    hw_.wait(nominal);
    const Clock::time_point now = Clock::now();
    cycle(start_time + nanoseconds(now - start), nanoseconds(now - last));
    last = now;
  }
  drive_command_ = DriveCommand{};
  drive_.setCommand(drive_command_);
  hw_.write(start_time + nanoseconds(last - start), nominal);
}

RequestReply ControlLoop::request(MachineEvent event, SetpointStream* stream) {
  const std::lock_guard<std::mutex> lock(request_mutex_);
  const auto deadline = Clock::now() + std::chrono::duration<double>(kAnswerTimeout + config_.enable_timeout);
  bool posted = false;
  while (Clock::now() < deadline) {
    if (!posted) posted = post(event, stream);
    if (posted) {
      if (auto answer = reply()) return *answer;
    } else {
      reply();  // a late answer to a request that was given up
    }
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return {false, std::string(toString(event)) + ": the control loop does not answer", false};
}

bool ControlLoop::setFeedOverride(double fraction) {
  if (!(fraction >= 0 && fraction <= kMaxFeedOverride)) return false;
  feed_override_ = fraction;
  return true;
}

bool ControlLoop::post(MachineEvent event, SetpointStream* stream) {
  if (awaiting_answer_ || !commands_.push(Command{event, stream})) return false;
  awaiting_answer_ = true;
  return true;
}

std::optional<RequestReply> ControlLoop::reply() {
  Answer answer;
  if (!answers_.pop(answer)) return std::nullopt;
  awaiting_answer_ = false;
  if (answer.refusal == Refusal::kNone) return RequestReply{true, "", true};
  std::string text = std::string(toString(answer.event)) + " refused: ";
  switch (answer.refusal) {
    case Refusal::kNone: break;
    case Refusal::kState:
      text +=
          std::string("the machine is in state ") + toString(answer.state) + "; allowed: " + allowedIn(answer.state);
      break;
    case Refusal::kEmergencyStop: text += "the emergency stop is pressed; release it first"; break;
    case Refusal::kDriveFault: text += "the drive reports a fault; reset it first"; break;
    case Refusal::kInterlock: text += toString(answer.interlock); break;
    case Refusal::kNoPower: text += "the drive did not switch its power on in time"; break;
    case Refusal::kMoved: text += "the axes do not stand where the job was planned to start; plan it again"; break;
    case Refusal::kFeedback: text += "the drive gives no valid, fresh positions"; break;
  }
  return RequestReply{false, text, true};
}

void ControlLoop::cycle(const ros::Time& time, const ros::Duration& period) {
  hw_.read(time, period);
  record_.time = time.toSec();
  record_.period = period.toSec();
  record_.has_setpoint = false;
  drive_command_.reset = false;

  observe();
  if (powered()) checkDrive();
  takeCommand();
  if (state_ == MachineState::kDisabled) awaitPower();
  if (state_ == MachineState::kHoming) awaitHoming();
  if (stream_) advanceJob();

  drive_command_.home = state_ == MachineState::kHoming;
  drive_command_.spindle = drive_command_.coolant = stream_ != nullptr;
  for (int i = 0; i < kAxisCount; ++i) joints_[static_cast<std::size_t>(i)].setCommand(command_[i]);
  drive_.setCommand(drive_command_);
  hw_.write(time, period);
  remember();

  record_.command = command_;
  record_.state = state_;
  record_.feed_override = feed_override_;
  if (records_.push(record_)) {
    record_.job_ended = false;
  } else {
    ++record_.records_lost;  // the end of a job is told by the next that is taken
  }
}

bool ControlLoop::powered() const { return state_ != MachineState::kDisabled && state_ != MachineState::kFault; }

void ControlLoop::observe() {
  record_.drive = drive_.getStatus();
  for (int i = 0; i < kAxisCount; ++i) {
    const JointHandle& joint = joints_[static_cast<std::size_t>(i)];
    record_.position[i] = joint.getPosition();
    record_.velocity[i] = joint.getVelocity();
  }
  feedback_age_ = record_.drive.feedback_count == last_feedback_ ? feedback_age_ + record_.period : 0;
  last_feedback_ = record_.drive.feedback_count;
  // Without power and while the drive homes, the commands follow, so that nothing moves when they count again; after a
  // fault they stay where they are.
  const bool follows = state_ == MachineState::kDisabled || state_ == MachineState::kHoming;
  if (follows && record_.position.isFinite().all()) {
    command_ = record_.position;
    written_count_ = 0;
  }
  record_.target = commandInEffect();
}

void ControlLoop::remember() {
  written_[next_written_] = command_;
  next_written_ = (next_written_ + 1) % written_.size();
  written_count_ = std::min(written_count_ + 1, written_.size());
}

const Axes& ControlLoop::commandInEffect() const {
  if (written_count_ == 0) return command_;
  const std::size_t back = 1 + std::min<std::size_t>(record_.drive.commands_waiting, written_count_ - 1);
  return written_[(next_written_ + written_.size() - back) % written_.size()];
}

void ControlLoop::checkDrive() {
  LoopFault fault;
  if (record_.drive.emergency_stop) {
    fault.kind = FaultKind::kEmergencyStop;
    return fail(fault);
  }
  // Ahead of what the drive does about it.
  if (record_.drive.underruns != underruns_before_) {
    fault.kind = FaultKind::kUnderrun;
    fault.value = static_cast<double>(record_.drive.underruns - underruns_before_);
    fault.cycle = record_.setpoint.cycle;
    return fail(fault);
  }
  if (record_.drive.fault) {
    fault.kind = FaultKind::kDriveFault;
    return fail(fault);
  }
  if (!record_.drive.enabled) {
    fault.kind = FaultKind::kPowerLost;
    return fail(fault);
  }
  if (!(feedback_age_ <= config_.feedback_timeout)) {
    fault.kind = FaultKind::kStaleFeedback;
    fault.value = feedback_age_;
    fault.limit = config_.feedback_timeout;
    return fail(fault);
  }
  checkPositions();
}

void ControlLoop::checkPositions() {
  LoopFault fault;
  for (int i = 0; i < kAxisCount; ++i) {
    fault.axis = i;
    if (!std::isfinite(record_.position[i])) {
      fault.kind = FaultKind::kInvalidFeedback;
      fault.value = record_.position[i];
      return fail(fault);
    }
    const double error = std::abs(record_.target[i] - record_.position[i]);
    if (!(error <= config_.following_error[i])) {
      fault.kind = FaultKind::kFollowingError;
      fault.value = error;
      fault.limit = config_.following_error[i];
      return fail(fault);
    }
  }
}

void ControlLoop::takeCommand() {
  Command command;
  if (pending_ || !commands_.pop(command)) return;
  pending_ = command;
  const bool complete = isRequest(command.event) && (command.stream || command.event != MachineEvent::kStart);
  if (!complete || !after(state_, command.event)) return answer(Refusal::kState);
  const Refusal refusal = carryOut(command);
  // Power takes its time: awaitPower() answers.
  if (refusal == Refusal::kNone && command.event == MachineEvent::kEnable && !powered()) return;
  answer(refusal);
}

ControlLoop::Refusal ControlLoop::carryOut(const Command& command) {
  switch (command.event) {
    case MachineEvent::kEnable: {
      const Refusal refusal = obstacleToPower();
      if (refusal != Refusal::kNone) return refusal;
      drive_command_.enable = true;
      waited_ = 0;
      return Refusal::kNone;
    }
    case MachineEvent::kHome:
      homing_seen_ = false;
      waited_ = 0;
      break;
    case MachineEvent::kStart: return start(command.stream);
    case MachineEvent::kHold:
    case MachineEvent::kCancel: stream_->hold(); break;
    case MachineEvent::kResume:
      if (openInterlock() != Interlock::kNone) return Refusal::kInterlock;
      record_.interlock = Interlock::kNone;
      stream_->resume();
      break;
    case MachineEvent::kRetract: stream_->retract(); break;
    case MachineEvent::kReset:
      if (record_.drive.emergency_stop) return Refusal::kEmergencyStop;
      drive_command_.reset = true;
      record_.fault = LoopFault{};
      break;
    case MachineEvent::kDisable: drive_command_.enable = false; break;
    case MachineEvent::kDone:
    case MachineEvent::kAtRest:
    case MachineEvent::kFault: break;
  }
  apply(command.event);
  return Refusal::kNone;
}

ControlLoop::Refusal ControlLoop::obstacleToPower() const {
  if (record_.drive.emergency_stop) return Refusal::kEmergencyStop;
  if (record_.drive.fault) return Refusal::kDriveFault;
  if (!record_.position.isFinite().all() || !(feedback_age_ <= config_.feedback_timeout)) return Refusal::kFeedback;
  return Refusal::kNone;
}

ControlLoop::Refusal ControlLoop::start(SetpointStream* stream) {
  if (!record_.drive.homed) return Refusal::kInterlock;
  if (!(stream->program().start() == command_).all()) return Refusal::kMoved;
  stream_ = stream;
  limit_check_.restart();
  record_.fault = LoopFault{};
  record_.interlock = Interlock::kNone;
  waited_ = 0;
  apply(MachineEvent::kStart);
  return Refusal::kNone;
}

void ControlLoop::answer(Refusal refusal) {
  answers_.push(Answer{pending_->event, state_, refusal, openInterlock()});
  pending_.reset();
}

void ControlLoop::awaitPower() {
  if (!pending_ || pending_->event != MachineEvent::kEnable) return;
  waited_ += record_.period;
  const Refusal refusal = obstacleToPower();
  if (refusal != Refusal::kNone) {
    drive_command_.enable = false;
    answer(refusal);
  } else if (record_.drive.enabled) {
    underruns_before_ = record_.drive.underruns;
    apply(MachineEvent::kEnable);
    answer(Refusal::kNone);
  } else if (!(waited_ <= config_.enable_timeout)) {
    drive_command_.enable = false;
    answer(Refusal::kNoPower);
  }
}

void ControlLoop::awaitHoming() {
  waited_ += record_.period;
  homing_seen_ |= record_.drive.homing;
  const bool over = homing_seen_ && !record_.drive.homing;
  if (over && record_.drive.homed) return apply(MachineEvent::kDone);
  if (!over && waited_ <= config_.homing_timeout) return;
  LoopFault fault;
  fault.kind = FaultKind::kHoming;
  fault.value = waited_;
  fault.limit = config_.homing_timeout;
  fail(fault);
}

void ControlLoop::awaitSpindle() {
  const Interlock open = openInterlock();
  if (open == Interlock::kNone) return apply(MachineEvent::kDone);
  waited_ += record_.period;
  if (waited_ <= config_.spindle_timeout) return;
  record_.fault.kind = FaultKind::kInterlock;
  record_.fault.interlock = open;
  record_.fault.value = waited_;
  record_.fault.limit = config_.spindle_timeout;
  endJob();
  apply(MachineEvent::kAtRest);
}

Interlock ControlLoop::openInterlock() const {
  if (!record_.drive.homed) return Interlock::kNotHomed;
  if (!record_.drive.spindle_at_speed) return Interlock::kSpindle;
  if (!record_.drive.coolant_on) return Interlock::kCoolant;
  if (!record_.drive.probe_free) return Interlock::kProbe;
  return Interlock::kNone;
}

void ControlLoop::checkInterlocks() {
  if (state_ == MachineState::kCanceling) return;
  const Interlock open = openInterlock();
  if (open != Interlock::kNone && record_.interlock == Interlock::kNone) {
    record_.interlock = open;
    // A wheel that is being lifted, or that is lifted, goes where it is safe already.
    if (after(state_, MachineEvent::kHold) && state_ != MachineState::kRetracting) {
      stream_->hold();
      apply(MachineEvent::kHold);
    }
  }
  // A wheel that dwells burns the tool, and one that stands still or runs dry spoils it.
  if (record_.interlock != Interlock::kNone && state_ == MachineState::kHeld) {
    stream_->retract();
    apply(MachineEvent::kRetract);
  }
}

void ControlLoop::advanceJob() {
  if (state_ == MachineState::kStarting) return awaitSpindle();
  checkInterlocks();
  stream_->setFeedOverride(feed_override_);
  move();
}

void ControlLoop::move() {
  Setpoint setpoint;
  const bool moves = stream_->next(setpoint);
  if (state_ == MachineState::kResuming && stream_->onPath()) apply(MachineEvent::kDone);
  if (!moves) return rest();
  if (const auto violation = limit_check_.check(setpoint)) {
    LoopFault fault;
    fault.kind = FaultKind::kLimit;
    fault.axis = violation->axis;
    fault.violation = *violation;
    return fail(fault);
  }
  command_ = setpoint.position;
  rested_ = 0;
  record_.has_setpoint = true;
  record_.setpoint = setpoint;
}

void ControlLoop::rest() {
  const std::uint64_t rested = rested_++;
  const bool on_the_way = state_ == MachineState::kRunning || state_ == MachineState::kResuming;
  if (on_the_way && !stream_->finished()) return;       // the feed override is 0
  if (record_.drive.commands_waiting > rested) return;  // the axes have not got the last setpoint yet
  if (on_the_way || state_ == MachineState::kCanceling) endJob();
  apply(MachineEvent::kAtRest);
}

void ControlLoop::endJob() {
  stream_ = nullptr;
  record_.job_ended = true;
  record_.interlock = Interlock::kNone;
}

void ControlLoop::fail(const LoopFault& fault) {
  record_.fault = fault;
  if (stream_) endJob();
  drive_command_.enable = false;
  apply(MachineEvent::kFault);
}

void ControlLoop::apply(MachineEvent event) {
  if (const auto next = after(state_, event)) state_ = *next;
}

}  // namespace flute_grinder
