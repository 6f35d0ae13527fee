#include "flute_grinder/control/control_loop.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>

// The cycle and the motion; all of it is real-time. Requests are executed in loop_execution.cpp.
namespace grinder {

namespace {

void append(FaultText& text, std::int64_t number) noexcept {
  std::array<char, 21> digits{};
  std::to_chars(digits.begin(), digits.end() - 1, number);
  text += digits.data();
}

}  // namespace

template <typename Call>
void ControlLoop::callDrive(const char* function, const Call& call) noexcept {
  try {
    return call();
  } catch (const std::exception& error) {
    thrown_ = textOrNone(error);
  } catch (...) {
    thrown_ = "an exception that is no std::exception";
  }
  FaultText by;
  by = " (thrown by its ";
  by += function;
  by += ")";
  thrown_.endWith(by);
  has_thrown_ = true;
}

ros::Duration ControlLoop::awaitCycle(Clock::time_point last) noexcept {
  constexpr std::int32_t kLongest = 3600;  // such as after a suspension of the computer [s]
  const ros::Duration nominal(config_.machine.period);
  ros::Duration period = nominal;
  bool waited = false;
  callDrive("wait()", [&] {
    period = drive_.wait(nominal);
    waited = true;
  });
  if (waited && period >= ros::Duration() && period <= ros::Duration(kLongest, 0)) return period;
  if (waited) {
    thrown_ = "its wait() has returned ";
    append(thrown_, period.sec);
    thrown_ += " s; allowed: 0 to 3600 s";
    has_thrown_ = true;
  }
  // Its result is unused: it is the time since its last call, perhaps many cycles ago.
  drive_.Drive::wait(nominal);
  return ros::Duration().fromNSec(std::chrono::nanoseconds(Clock::now() - last).count());
}

void ControlLoop::writeOff(const DriveCycle& cycle) noexcept {
  DriveCommand off;
  std::copy(command_.data(), command_.data() + kAxisCount, off.position.begin());
  if (has_positions_) callDrive("write()", [&] { drive_.write(cycle, off); });
}

void ControlLoop::cycle(const ros::Time& time, const ros::Duration& period) {
  const DriveCycle times{time, period, ros::Duration(config_.machine.period)};
  sample_.time = time.toSec();
  sample_.period = period.toSec();
  const bool moving = sample_.has_setpoint && (sample_.setpoint.velocity != 0).any();
  sample_.has_setpoint = false;
  sample_.job = next_status_.jobs_started;
  drive_command_.reset = false;

  readDrive(times);
  trackMotion();
  moving_unbuffered_ = moving && sample_.drive.commands_waiting == 0;
  if (isPowered(state_)) checkDrive();
  watchClients();
  executeRequests();
  awaitPower();
  if (state_ == MachineState::kHoming) awaitHoming();
  advance();

  writeDrive(times);
  publish();
}

void ControlLoop::readDrive(const DriveCycle& cycle) {
  callDrive("read()", [&] { drive_.read(cycle, feedback_); });
  const std::uint64_t last_feedback = sample_.drive.feedback_count;
  const Axes last = sample_.position;
  const double elapsed = sample_.feedback_age + sample_.period;
  touched_ = sample_.drive.probe_contact;
  sample_.drive = feedback_.status;
  if (has_thrown_) {
    sample_.drive.fault = true;
    sample_.drive.fault_text = thrown_;
    has_thrown_ = false;
  }
  boundCommandsWaiting();
  observeHang();
  unwanted_power_ = sample_.drive.enabled && !drive_command_.enable ? unwanted_power_ + sample_.period : 0;
  sample_.power_stays = !(unwanted_power_ <= config_.enable_timeout);
  drive_checks_.observe(sample_);
  sample_.feedback_age = sample_.drive.feedback_count == last_feedback ? sample_.feedback_age + sample_.period : 0;
  std::copy(feedback_.position.begin(), feedback_.position.end(), sample_.position.data());
  std::copy(feedback_.velocity.begin(), feedback_.velocity.end(), sample_.velocity.data());
  // Before the first reading the feedback still has its initial value 0.
  const bool finite = sample_.position.isFinite().all();
  has_positions_ = has_positions_ || (sample_.drive.feedback_count > 0 && finite);
  next_status_.position_valid = has_positions_ && finite && sample_.feedback_age <= config_.feedback_timeout;
  const AxisFlags credible = credibleFrom(last, elapsed);
  if (sample_.feedback_age == 0) settled_ = credible.all();
  // Without power and during homing the commands follow the positions, so nothing moves when commands take effect
  // again; after a fault the commands do not change.
  const bool follows = state_ == MachineState::kDisabled || state_ == MachineState::kHoming;
  if (follows && finite) {
    command_ = sample_.position;
    history_.clear();
  }
  sample_.command_in_effect = history_.empty() ? command_ : history_.inEffect(sample_.drive.commands_waiting).command;
  judgeY(credible[kY]);
  readSwivel();
}

/// Limits the drive's count of waiting commands to its buffer: with a false count the axes would never come to rest.
void ControlLoop::boundCommandsWaiting() {
  DriveStatus& drive = sample_.drive;
  const std::uint32_t reported = drive.commands_waiting;
  if (reported <= capabilities_.buffer) return;
  drive.commands_waiting = capabilities_.buffer;
  if (drive.fault) return;
  drive.fault = true;
  drive.fault_text = "it has reported ";
  append(drive.fault_text, reported);
  drive.fault_text += " commands waiting; allowed: up to ";
  append(drive.fault_text, capabilities_.buffer);
}

/// Reports a drive fault if the watchdog has called powerOff(), whatever the drive says, until the call has returned.
void ControlLoop::observeHang() {
  PowerOff power_off = power_off_;
  has_hung_ = power_off != PowerOff::kNotCalled;
  if (!has_hung_) return;
  sample_.drive.fault = true;
  sample_.drive.fault_text = "it has returned to the control loop too late";
  if (power_off == PowerOff::kCalled) sample_.drive.fault_text += "; its powerOff() has not returned";
  // A second call may have begun meanwhile: it stays.
  if (power_off == PowerOff::kReturned) power_off_.compare_exchange_strong(power_off, PowerOff::kNotCalled);
}

/// Whether each axis can have moved to its reading. If not, the axis has a new reference or the reading is wrong; the
/// next reading shows which.
/// @param last previous reading [m], A [rad]. @param elapsed time since then [s].
ControlLoop::AxisFlags ControlLoop::credibleFrom(const Axes& last, double elapsed) const {
  // A motion without feedback is believed for no longer than feedback_timeout.
  const Axes most =
      config_.following_error + config_.machine.limits.max_velocity * std::min(elapsed, config_.feedback_timeout);
  return (sample_.position - last).abs() <= most;  // false for NaN
}

/// After a reading of Y that the axis cannot have reached, Y counts as not homed until it is homed: its position is
/// unknown.
/// @param credible whether Y can have moved to its reading without power.
void ControlLoop::judgeY(bool credible) {
  const bool was_homed = y_homed_;
  y_homed_ = state_ != MachineState::kHoming && sample_.drive.homed && has_positions_;
  if (state_ == MachineState::kHoming) return;
  // With a drive that cannot home, Y is trusted again after a lift, because no better reading will come.
  if (!capabilities_.homing && !wheel_.wheel().in_work) wheel_.doubtY(false);
  const bool right = isPowered(state_) ? sample_.followingError(kY) <= config_.following_error[kY]  // false for NaN
                                       : !was_homed || credible;
  if (y_homed_ && !right) wheel_.doubtY(true);
  sample_.drive.homed = sample_.drive.homed && !wheel_.wheel().y_doubted;
}

void ControlLoop::readSwivel() {
  if (std::isfinite(sample_.drive.swivel)) {
    sample_.swivel = {sample_.drive.swivel, true};
  } else if (sample_.swivel.measured) {
    sample_.swivel = {};  // without its encoder the swivel's angle is unknown
  }
}

void ControlLoop::trackMotion() {
  if (sample_.drive.homed || !isPowered(state_)) wheel_.forgetLift();
  if (stream_) {
    const JobTrack& reached = history_.inEffect(sample_.drive.commands_waiting).track;
    // The drive's buffer may still hold commands of the previous job.
    if (reached.job != next_status_.jobs_started || reached.setpoints == 0) return;
    next_status_.place = reached.place;
    next_status_.strokes_ended_at = reached.strokes_ended_at;
    wheel_.followJob(sample_.command_in_effect[kY]);
  } else if (state_ != MachineState::kLifting) {
    std::optional<double> y;
    if (sample_.drive.homed && next_status_.position_valid) y = sample_.position[kY];
    wheel_.observePosition(y, isPowered(state_), config_.machine.period);
  }
}

void ControlLoop::checkDrive() {
  if (has_hung_) {  // also the cause of the late cycle, underruns and lost power
    LoopFault fault;
    fault.kind = FaultKind::kDriveFault;
    fault.drive_text = sample_.drive.fault_text;
    return fail(fault);
  }
  if (const auto fault = drive_checks_.findFault(sample_, moving_unbuffered_)) fail(*fault);
}

void ControlLoop::writeDrive(const DriveCycle& cycle) {
  // Assembled here and copied as a whole, like sample and status.
  DriveCommand drive_command = drive_command_;
  drive_command.home = state_ == MachineState::kHoming;
  // Without a job, a fault, lost power, homing or a lift switches off a spindle or coolant that was on by hand.
  if (!stream_ && !after(state_, MachineEvent::kSpindleOn)) spindle_ = coolant_ = false;
  if (!stream_ && !sample_.drive.probe_free) spindle_ = false;
  sample_.spindle_commanded = drive_command.spindle = spindle_;
  sample_.coolant_commanded = drive_command.coolant = coolant_;
  std::copy(command_.data(), command_.data() + kAxisCount, drive_command.position.begin());
  // Before the first positions there is no command to write.
  if (has_positions_) callDrive("write()", [&] { drive_.write(cycle, drive_command); });
  history_.add({command_, written_});
}

void ControlLoop::publish() {
  sample_.command = command_;
  sample_.state = state_;
  sample_.feed_override = feed_override_;
  sample_.wheel_in_work = wheel_.wheel().in_work;
  sample_.distance_to_go = distanceToGo();

  ++next_status_.cycles;
  next_status_.time = sample_.time;
  next_status_.state = state_;
  next_status_.homed = sample_.drive.homed;
  Eigen::Map<Axes>(next_status_.command.data()) = command_;
  Eigen::Map<Axes>(next_status_.position.data()) = sample_.position;
  next_status_.feed_override = sample_.feed_override;
  next_status_.swivel = sample_.swivel;
  next_status_.probe_contact = sample_.drive.probe_contact;
  next_status_.setpoints_written = written_.setpoints;
  next_status_.wheel = wheel_.wheel();

  // Both are filled in before they are copied, because a copy right after a write stalls.
  if (samples_.push(sample_)) {
    sample_.job_ended = false;
  } else {
    ++sample_.samples_lost;  // job_ended stays set for the next sample that fits
  }
  status_.store(next_status_);
}

/// For a job, the distance to the end of the program's move that contains the setpoint in effect.
Axes ControlLoop::distanceToGo() const {
  if (jogging_ || state_ == MachineState::kLifting) {
    Axes to_go = Axes::Zero();
    const int axis = axis_move_.axis();
    // A continuous jog has no end of its own.
    if (!(jogging_ && continuous_)) to_go[axis] = axis_move_.to() - sample_.position[axis];
    return to_go;
  }
  if (!stream_) return Axes::Zero();
  return stream_->program().moves()[next_status_.place.move_index].to + job_offset_ - sample_.position;
}

void ControlLoop::awaitHoming() {
  waited_ += sample_.period;
  homing_of_before_ &= sample_.drive.homing;
  homing_seen_ |= sample_.drive.homing && !homing_of_before_;
  const bool over = homing_seen_ && !sample_.drive.homing, is_fresh = sample_.feedback_age == 0;
  // Finding the reference may make the readings jump, but only once.
  const bool jumps_again = homing_over_ && is_fresh && !settled_;
  homing_over_ = over && (homing_over_ || is_fresh);
  const bool failed = over && (jumps_again || !sample_.drive.homed);
  if (jumps_again) wheel_.doubtY(true);
  if (homing_over_ && !failed && settled_) {
    wheel_.doubtY(false);
    return apply(MachineEvent::kDone);
  }
  if (!failed && waited_ <= config_.homing_timeout) return;
  LoopFault fault;
  fault.kind = FaultKind::kHoming;
  fault.value = waited_;
  fault.limit = config_.homing_timeout;
  fail(fault);
}

/// @return whether the job begins in this cycle. Its first setpoint is where the axes stand.
bool ControlLoop::awaitInterlocks() {
  const Interlock open = openInterlock();
  if (open == Interlock::kNone) {
    apply(MachineEvent::kDone);
    if (stream_->holding()) apply(MachineEvent::kHold);
    return true;
  }
  waited_ += sample_.period;
  if (waited_ <= config_.spindle_timeout) return false;
  sample_.fault.kind = FaultKind::kInterlock;
  sample_.fault.interlock = open;
  sample_.fault.value = waited_;
  sample_.fault.limit = config_.spindle_timeout;
  endJob(JobEnd::kFault);
  comeToRest();
  return false;
}

// ---------------------------------------------------------------------------------------------------------------------
// Motion

void ControlLoop::advance() {
  slowDownIfLate();
  if (jogging_) {
    advanceJog();
  } else if (stream_) {
    advanceJob();
  } else if (state_ == MachineState::kLifting) {
    advanceLift();
  }
}

void ControlLoop::slowDownIfLate() {
  if (!moving_unbuffered_) return;
  const double periods = sample_.period / config_.machine.period;
  if (!(periods >= config_.late_slow_down)) return;
  // A delay of several periods: the axes covered only one period's distance in that time.
  if (stream_) stream_->slowDown(1 / periods);
  axis_move_.slowDown(1 / periods);
  limit_check_.slowDown(1 / periods);
}

void ControlLoop::advanceJob() {
  if (state_ == MachineState::kStarting && !awaitInterlocks()) return;
  // Before its first setpoint the job has not moved the axes.
  if (state_ == MachineState::kCanceling && written_.setpoints == 0) return restJob();
  checkInterlocks();
  stream_->setFeedOverride(feed_override_);
  bool moves = stream_->next(sample_.setpoint);
  if (!moves && beginLiftOff()) moves = stream_->next(sample_.setpoint);
  if (state_ == MachineState::kResuming && stream_->onPath()) apply(MachineEvent::kDone);
  if (!moves) return restJob();
  commandOfJob();
}

void ControlLoop::commandOfJob() {
  command(job_offset_);
  if (stream_) written_.add(sample_.setpoint);
}

void ControlLoop::advanceLift() {
  if (!advanceAxisMove()) return;
  if (axis_move_.finished()) wheel_.finishLift();
  comeToRest();
}

bool ControlLoop::advanceAxisMove() {
  Setpoint& setpoint = sample_.setpoint;
  if (!axis_move_.next(setpoint)) return allReachedAxes();
  if (stream_) {
    // The axes rest already where the move begins.
    if (setpoint.cycle == 0 && !axis_move_.next(setpoint)) return allReachedAxes();
    const Axes at = setpoint.position;
    setpoint.position -= job_offset_;
    stream_->adopt(setpoint);
    commandOfJob();
    // Without the rounding of the conversion to work coordinates and back, an end at a limit is reached exactly.
    if (sample_.has_setpoint) command_ = at;
    return false;
  }
  command();
  if (sample_.has_setpoint) sample_.job = 0;
  return false;
}

Interlock ControlLoop::openInterlock() const {
  const Interlock open = grinder::openInterlock(sample_.drive, spindle_, coolant_);
  if (open != Interlock::kNone || !stream_) return open;
  if (!sample_.swivel.isAt(job_swivel_)) return Interlock::kSwivel;
  const bool entered = in_journal_ || jobInJournal() == next_status_.jobs_started;
  return entered ? Interlock::kNone : Interlock::kJournal;
}

void ControlLoop::checkInterlocks() {
  if (state_ == MachineState::kCanceling) return;
  const Interlock open = openInterlock();
  // A spindle or coolant that the operator has switched off is no failure; while it is off, the job is not resumed.
  const bool by_hand = switched_by_hand_ && (open == Interlock::kSpindle || open == Interlock::kCoolant);
  if (open != Interlock::kNone && !by_hand && sample_.interlock == Interlock::kNone) {
    sample_.interlock = open;
    // A wheel that is being lifted is moving to safety; one that was lifted is already safe.
    if (after(state_, MachineEvent::kHold) && state_ != MachineState::kRetracting) {
      stream_->hold();
      apply(MachineEvent::kHold);
    }
  }
  // A dwelling wheel burns the tool; a stopped or dry wheel damages it.
  if (sample_.interlock != Interlock::kNone && state_ == MachineState::kHeld) {
    stream_->retract();
    apply(MachineEvent::kRetract);
  }
}

/// Commands the sample's setpoint, unless it exceeds a limit.
/// @param offset machine position - position of the setpoint [m], A [rad].
void ControlLoop::command(const Axes& offset) {
  const Setpoint& setpoint = sample_.setpoint;
  if (const auto violation = limit_check_.check(setpoint, offset)) {
    LoopFault fault;
    fault.kind = FaultKind::kLimit;
    fault.axis = violation->axis;
    fault.violation = *violation;
    return fail(fault);
  }
  // The check allows for rounding beyond a limit; the command does not.
  command_ = limit_check_.clamped(setpoint.position + offset);
  rested_ = 0;
  sample_.has_setpoint = true;
}

/// Whether the last setpoint has reached the axes. It is written in every cycle, so with a buffer
/// that never empties, this is the case once it has been written as often as commands wait.
bool ControlLoop::allReachedAxes() { return sample_.drive.commands_waiting <= rested_++; }

void ControlLoop::restJob() {
  const bool all_reached = allReachedAxes();
  const bool on_the_way = state_ == MachineState::kRunning || state_ == MachineState::kResuming;
  if (on_the_way && stream_->rest() != Rest::kEnd) return;
  if (!all_reached) return;
  if (on_the_way) {
    endJob(JobEnd::kDone);
  } else if (state_ == MachineState::kCanceling) {
    endJob(JobEnd::kCanceled);
  }
  comeToRest();
}

bool ControlLoop::beginLiftOff() {
  const bool in_work = written_.setpoints > 0 && command_[kY] < wheel_.wheel().clear_y;
  if (state_ != MachineState::kCanceling || !may_lift_off_ || !in_work) return false;
  may_lift_off_ = false;
  stream_->retract();
  return true;
}

void ControlLoop::comeToRest() {
  apply(MachineEvent::kAtRest);
  if (power_off_next_) switchOff();
}

void ControlLoop::endJob(JobEnd end) {
  stream_ = nullptr;
  spindle_ = coolant_ = false;
  sample_.job_ended = true;
  sample_.interlock = Interlock::kNone;
  ++next_status_.jobs_ended;
  next_status_.end = end;
  if (end == JobEnd::kFault) next_status_.fault = sample_.fault;
}

void ControlLoop::fail(const LoopFault& fault) {
  sample_.fault = fault;
  if (stream_) endJob(JobEnd::kFault);
  if (jogging_) endJog();
  drive_command_.enable = power_off_next_ = false;
  apply(MachineEvent::kFault);
}

void ControlLoop::apply(MachineEvent event) {
  if (const auto next = after(state_, event)) state_ = *next;
}

}  // namespace grinder
