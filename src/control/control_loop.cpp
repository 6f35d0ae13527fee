#include "flute_grinder/control/control_loop.h"

#include <algorithm>
#include <cmath>

// The cycle, all of it real-time; what other threads call is in loop_thread.cpp.
namespace flute_grinder {

void ControlLoop::cycle(const ros::Time& time, const ros::Duration& period) {
  hw_.read(time, period);
  record_.time = time.toSec();
  record_.period = period.toSec();
  moving_ = record_.has_setpoint && (record_.setpoint.velocity != 0).any();
  record_.has_setpoint = false;
  record_.job = now_.jobs_started;
  drive_command_.reset = false;

  observe();
  if (powered()) checkDrive();
  takeRequests();
  awaitPower();
  if (state_ == MachineState::kHoming) awaitHoming();
  advance();

  writeDrive(time, period);
  tell();
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
    history_.clear();
  }
  record_.target = history_.empty() ? command_ : history_.inEffect(record_.drive.commands_waiting).command;
  watchWheel();
}

void ControlLoop::watchWheel() {
  Wheel& wheel = now_.wheel;
  if (stream_) {
    const JobTrack& got = history_.inEffect(record_.drive.commands_waiting).track;
    // What waits in the drive may be of the job before.
    if (got.job != now_.jobs_started || got.setpoints == 0) return;
    now_.place = got.place;
    now_.strokes_ended_at = got.strokes_ended_at;
    wheel.in_work = record_.target[kY] < wheel.clear_y;
  } else if (state_ != MachineState::kLifting) {
    // By the drive or by hand.
    const bool knows = record_.drive.homed && feedback_age_ <= config_.feedback_timeout;
    const double y = record_.position[kY];
    if (knows && std::isfinite(y) && y >= wheel.clear_y) wheel.in_work = false;
  }
}

void ControlLoop::advance() {
  takeUpSpeed();
  if (stream_) {
    advanceJob();
  } else if (state_ == MachineState::kLifting) {
    advanceLift();
  }
}

void ControlLoop::writeDrive(const ros::Time& time, const ros::Duration& period) {
  drive_command_.home = state_ == MachineState::kHoming;
  drive_command_.spindle = drive_command_.coolant = stream_ != nullptr;
  for (int i = 0; i < kAxisCount; ++i) joints_[static_cast<std::size_t>(i)].setCommand(command_[i]);
  drive_.setCommand(drive_command_);
  hw_.write(time, period);
  history_.add({command_, written_});
}

void ControlLoop::tell() {
  record_.command = command_;
  record_.state = state_;
  record_.feed_override = feed_override_;
  record_.wheel_in_work = now_.wheel.in_work;
  if (records_.push(record_)) {
    record_.job_ended = false;
  } else {
    ++record_.records_lost;  // the end of a job is told by the next that is taken
  }

  ++now_.cycles;
  now_.time = record_.time;
  now_.state = state_;
  now_.homed = record_.drive.homed;
  std::copy(command_.data(), command_.data() + kAxisCount, now_.command.begin());
  now_.feed_override = record_.feed_override;
  now_.setpoints_written = written_.setpoints;
  status_.store(now_);
}

// ---------------------------------------------------------------------------------------------------------------------
// Requests

void ControlLoop::takeRequests() {
  // First looked at, last carried out: whoever stops has stopped all that was asked for before.
  const StopRoad::Taken stops = stops_.take();
  if (const auto job = starts_.take()) starts_.answer(answerTo(MachineEvent::kStart, start(*job)));
  if (const auto event = requests_.take()) takeRequest(*event);
  for (const MachineEvent stop : StopRoad::kStops) {
    if (!stops.has(stop)) continue;
    const Answer answer = answerTo(stop, carryOut(stop));
    if (stops.asked(stop)) stops_.answer(answer);
  }
}

void ControlLoop::takeRequest(MachineEvent event) {
  const Refusal refusal = isTrigger(event) ? carryOut(event) : Refusal::kState;
  // Power takes its time: awaitPower() answers.
  if (!awaiting_power_) requests_.answer(answerTo(event, refusal));
}

Answer ControlLoop::answerTo(MachineEvent event, Refusal refusal) const {
  return {event, state_, refusal, openInterlock(), liftTarget(), config_.machine.limits.max_position[kY]};
}

Refusal ControlLoop::carryOut(MachineEvent event) {
  if (!after(state_, event)) return Refusal::kState;
  if (isStop(event)) return stopMotion(event);
  switch (event) {
    case MachineEvent::kEnable: return enable();
    case MachineEvent::kLift: return lift();
    case MachineEvent::kHome:
      if (now_.wheel.in_work) return Refusal::kInWork;
      homing_seen_ = false;
      waited_ = 0;
      break;
    case MachineEvent::kResume:
      // What a job waits for before it begins may still come.
      if (state_ != MachineState::kStarting && openInterlock() != Interlock::kNone) return Refusal::kInterlock;
      record_.interlock = Interlock::kNone;
      stream_->resume();
      break;
    case MachineEvent::kRetract: stream_->retract(); break;
    case MachineEvent::kReset:
      if (record_.drive.emergency_stop) return Refusal::kEmergencyStop;
      drive_command_.reset = true;
      record_.fault = LoopFault{};
      break;
    default: return Refusal::kState;
  }
  apply(event);
  return Refusal::kNone;
}

Refusal ControlLoop::stopMotion(MachineEvent event) {
  const bool off = event == MachineEvent::kDisable;
  if (stream_) {
    power_off_next_ |= off;
    // A wheel that is being lifted goes on to where a canceled job is to leave it.
    const bool lifting = state_ == MachineState::kCanceling || state_ == MachineState::kRetracting;
    const bool hold = event == MachineEvent::kHold;
    if (hold || !lifting) stream_->hold();
    if (hold && state_ == MachineState::kCanceling) lifts_off_ = false;
  } else if (state_ == MachineState::kLifting) {
    power_off_next_ |= off;
    lift_.hold();
  } else if (state_ == MachineState::kFault) {
    return Refusal::kNone;
  } else {
    switchOff();
    return Refusal::kNone;
  }
  apply(event);
  return Refusal::kNone;
}

Refusal ControlLoop::enable() {
  const Refusal refusal = obstacleToPower();
  if (refusal != Refusal::kNone || powered()) return refusal;
  drive_command_.enable = true;
  awaiting_power_ = true;
  waited_ = 0;
  return Refusal::kNone;
}

Refusal ControlLoop::obstacleToPower() const {
  if (record_.drive.emergency_stop) return Refusal::kEmergencyStop;
  if (record_.drive.fault) return Refusal::kDriveFault;
  if (!record_.position.isFinite().all() || !(feedback_age_ <= config_.feedback_timeout)) return Refusal::kFeedback;
  return Refusal::kNone;
}

Refusal ControlLoop::start(const Start& job) {
  if (!after(state_, MachineEvent::kStart)) return Refusal::kState;
  if (now_.wheel.in_work) return Refusal::kInWork;
  if (!record_.drive.homed) return Refusal::kInterlock;
  if (!(job.stream->program().start() == command_).all()) return Refusal::kMoved;
  stream_ = job.stream;
  limit_check_.restart();
  record_.fault = LoopFault{};
  record_.interlock = Interlock::kNone;
  record_.job_ended = false;  // of a job before, whose record was lost
  written_ = JobTrack{};
  written_.job = record_.job = ++now_.jobs_started;
  now_.end = JobEnd::kNone;
  now_.fault = LoopFault{};
  now_.place = Place{};
  now_.strokes_ended_at = 0;
  now_.wheel = job.wheel;
  waited_ = 0;
  lifts_off_ = true;
  power_off_next_ = false;
  apply(MachineEvent::kStart);
  return Refusal::kNone;
}

double ControlLoop::liftTarget() const {
  return record_.drive.homed ? now_.wheel.clear_y : command_[kY] + now_.wheel.lift;
}

Refusal ControlLoop::lift() {
  if (!now_.wheel.in_work) return Refusal::kNotInWork;
  if (!(liftTarget() <= config_.machine.limits.max_position[kY])) return Refusal::kLiftTooFar;
  lift_.begin(command_, liftTarget());
  limit_check_.restart();
  power_off_next_ = false;
  apply(MachineEvent::kLift);
  return Refusal::kNone;
}

// ---------------------------------------------------------------------------------------------------------------------
// Checks

void ControlLoop::checkDrive() {
  LoopFault fault;
  if (record_.drive.emergency_stop) {
    fault.kind = FaultKind::kEmergencyStop;
    return fail(fault);
  }
  // Ahead of what the drive does about them.
  if (record_.drive.underruns != underruns_before_) {
    fault.kind = FaultKind::kUnderrun;
    fault.value = static_cast<double>(record_.drive.underruns - underruns_before_);
    fault.cycle = record_.setpoint.cycle;
    return fail(fault);
  }
  const double longest = config_.late_fault * config_.machine.period;
  if (axesWaited() && !(record_.period <= longest)) {
    fault.kind = FaultKind::kLate;
    fault.value = record_.period;
    fault.limit = longest;
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
  checkFeedback();
}

bool ControlLoop::axesWaited() const { return moving_ && record_.drive.commands_waiting == 0; }

void ControlLoop::checkFeedback() {
  if (feedback_age_ <= config_.feedback_timeout) return checkPositions();
  LoopFault fault;
  fault.kind = FaultKind::kStaleFeedback;
  fault.value = feedback_age_;
  fault.limit = config_.feedback_timeout;
  fail(fault);
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

// ---------------------------------------------------------------------------------------------------------------------
// What a state waits for

void ControlLoop::awaitPower() {
  if (!awaiting_power_) return;
  waited_ += record_.period;
  const Refusal refusal = obstacleToPower();
  if (refusal != Refusal::kNone) {
    drive_command_.enable = false;
    answerEnable(refusal);
  } else if (record_.drive.enabled) {
    underruns_before_ = record_.drive.underruns;
    apply(MachineEvent::kEnable);
    answerEnable(Refusal::kNone);
  } else if (!(waited_ <= config_.enable_timeout)) {
    drive_command_.enable = false;
    answerEnable(Refusal::kNoPower);
  }
}

void ControlLoop::answerEnable(Refusal refusal) {
  awaiting_power_ = false;
  requests_.answer(answerTo(MachineEvent::kEnable, refusal));
}

void ControlLoop::switchOff() {
  drive_command_.enable = false;
  if (awaiting_power_) answerEnable(Refusal::kWithdrawn);
  power_off_next_ = false;
  apply(MachineEvent::kDisable);
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
  if (open == Interlock::kNone) {
    apply(MachineEvent::kDone);
    if (stream_->holding()) apply(MachineEvent::kHold);
    return;
  }
  waited_ += record_.period;
  if (waited_ <= config_.spindle_timeout) return;
  record_.fault.kind = FaultKind::kInterlock;
  record_.fault.interlock = open;
  record_.fault.value = waited_;
  record_.fault.limit = config_.spindle_timeout;
  endJob(JobEnd::kFault);
  comeToRest();
}

// ---------------------------------------------------------------------------------------------------------------------
// Motion

void ControlLoop::takeUpSpeed() {
  if (!axesWaited()) return;
  const double periods = record_.period / config_.machine.period;
  if (!(periods >= config_.late_slow_down)) return;
  // One way was gone in the time of so many.
  if (stream_) stream_->slowDown(1 / periods);
  lift_.slowDown(1 / periods);
  limit_check_.slowDown(1 / periods);
}

void ControlLoop::advanceJob() {
  if (state_ == MachineState::kStarting) return awaitSpindle();
  // Nothing has moved yet, and nothing needs to.
  if (state_ == MachineState::kCanceling && written_.setpoints == 0) return restJob();
  checkInterlocks();
  stream_->setFeedOverride(feed_override_);
  Setpoint setpoint;
  bool moves = stream_->next(setpoint);
  if (!moves && liftsOff()) moves = stream_->next(setpoint);
  if (state_ == MachineState::kResuming && stream_->onPath()) apply(MachineEvent::kDone);
  if (!moves) return restJob();
  write(setpoint);
  if (stream_) written_.add(setpoint);
}

void ControlLoop::advanceLift() {
  Setpoint setpoint;
  if (lift_.next(setpoint)) {
    record_.job = 0;
    return write(setpoint);
  }
  if (!axesGotAll()) return;
  if (lift_.finished()) now_.wheel.in_work = false;
  comeToRest();
}

void ControlLoop::write(const Setpoint& setpoint) {
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

bool ControlLoop::axesGotAll() { return record_.drive.commands_waiting <= rested_++; }

void ControlLoop::restJob() {
  const bool got_all = axesGotAll();
  const bool on_the_way = state_ == MachineState::kRunning || state_ == MachineState::kResuming;
  if (on_the_way && !stream_->finished()) return;  // the feed override is 0
  if (!got_all) return;
  if (on_the_way) {
    endJob(JobEnd::kDone);
  } else if (state_ == MachineState::kCanceling) {
    endJob(JobEnd::kCanceled);
  }
  comeToRest();
}

bool ControlLoop::liftsOff() {
  const bool in_work = written_.setpoints > 0 && command_[kY] < now_.wheel.clear_y;
  if (state_ != MachineState::kCanceling || !lifts_off_ || !in_work) return false;
  lifts_off_ = false;
  stream_->retract();
  return true;
}

void ControlLoop::comeToRest() {
  apply(MachineEvent::kAtRest);
  if (power_off_next_) switchOff();
}

void ControlLoop::endJob(JobEnd end) {
  stream_ = nullptr;
  record_.job_ended = true;
  record_.interlock = Interlock::kNone;
  ++now_.jobs_ended;
  now_.end = end;
  if (end == JobEnd::kFault) now_.fault = record_.fault;
}

void ControlLoop::fail(const LoopFault& fault) {
  record_.fault = fault;
  if (stream_) endJob(JobEnd::kFault);
  drive_command_.enable = power_off_next_ = false;
  apply(MachineEvent::kFault);
}

void ControlLoop::apply(MachineEvent event) {
  if (const auto next = after(state_, event)) state_ = *next;
}

}  // namespace flute_grinder
