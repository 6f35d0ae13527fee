#include "flute_grinder/control/control_loop.h"

#include <cmath>
#include <optional>

// The cycle and the motion; all of it is real-time. Requests are executed in loop_execution.cpp.
namespace grinder {

void ControlLoop::cycle(const ros::Time& time, const ros::Duration& period) {
  const DriveCycle times{time, period, ros::Duration(now_.config.machine.period)};
  now_.sample.time = time.toSec();
  now_.sample.period = period.toSec();
  const bool moving = now_.sample.has_setpoint && (now_.sample.setpoint.velocity != 0).any();
  now_.sample.has_setpoint = false;
  now_.sample.job = now_.status.jobs_started;
  resets_ = false;

  readDrive(times);
  trackMotion();
  moving_unbuffered_ = moving && now_.sample.drive.commands_waiting == 0;
  if (isPowered(now_.sample.state)) checkDrive();
  jog_.watch();
  executeRequests();
  awaitPower();
  if (now_.sample.state == MachineState::kHoming) awaitHoming();
  advance();

  writeDrive(times);
  publish();
}

void ControlLoop::readDrive(const DriveCycle& cycle) {
  link_.read(cycle, now_.sample);
  power_.observe(now_.sample);
  drive_checks_.observe(now_.sample);
  const bool finite = now_.sample.position.isFinite().all();
  now_.status.position_valid =
      link_.hasPositions() && finite && now_.sample.feedback_age <= now_.config.feedback_timeout;
  // Without power and during homing the commands follow the positions, so nothing moves when commands take effect
  // again; after a fault the commands do not change.
  const bool follows = now_.sample.state == MachineState::kDisabled || now_.sample.state == MachineState::kHoming;
  if (follows && finite) {
    now_.sample.command = now_.sample.position;
    history_.clear();
  }
  now_.sample.command_in_effect =
      history_.empty() ? now_.sample.command : history_.inEffect(now_.sample.drive.commands_waiting).command;
  judgeY();
  if (std::isfinite(now_.sample.drive.swivel)) {
    now_.sample.swivel = {now_.sample.drive.swivel, true};
  } else if (now_.sample.swivel.measured) {
    now_.sample.swivel = {};  // without its encoder the swivel's angle is unknown
  }
}

/// After a reading of Y that the axis cannot have reached, Y counts as not homed until it is homed: its position is
/// unknown.
void ControlLoop::judgeY() {
  const bool was_homed = y_homed_;
  y_homed_ = now_.sample.state != MachineState::kHoming && now_.sample.drive.homed && link_.hasPositions();
  if (now_.sample.state == MachineState::kHoming) return;
  // With a drive that cannot home, Y is trusted again after a lift, because no better reading will come.
  if (!capabilities().homing && !now_.wheel.wheel().in_work) now_.wheel.doubtY(false);
  const bool right = isPowered(now_.sample.state)
                         ? now_.sample.followingError(kY) <= now_.config.following_error[kY]  // false for NaN
                         : !was_homed || link_.isCredible(kY);
  if (y_homed_ && !right) now_.wheel.doubtY(true);
  now_.sample.drive.homed = now_.sample.drive.homed && !now_.wheel.wheel().y_doubted;
}

void ControlLoop::trackMotion() {
  if (now_.sample.drive.homed || !isPowered(now_.sample.state)) now_.wheel.forgetLift();
  if (job_.inProgress()) {
    const JobTrack& reached = history_.inEffect(now_.sample.drive.commands_waiting).track;
    // The drive's buffer may still hold commands of the previous job.
    if (reached.job != now_.status.jobs_started || reached.setpoints == 0) return;
    now_.status.place = reached.place;
    now_.status.strokes_ended_at = reached.strokes_ended_at;
    now_.wheel.followJob(now_.sample.command_in_effect[kY]);
  } else if (now_.sample.state != MachineState::kLifting) {
    std::optional<double> y;
    if (now_.sample.drive.homed && now_.status.position_valid) y = now_.sample.position[kY];
    now_.wheel.observePosition(y, isPowered(now_.sample.state), now_.config.machine.period);
  }
}

void ControlLoop::checkDrive() {
  if (power_.hasHung()) {  // also the cause of the late cycle, underruns and lost power
    LoopFault fault;
    fault.kind = FaultKind::kDriveFault;
    fault.drive_text = now_.sample.drive.fault_text;
    return fail(fault);
  }
  if (const auto fault = drive_checks_.findFault(now_.sample, moving_unbuffered_)) fail(*fault);
}

void ControlLoop::writeDrive(const DriveCycle& cycle) {
  job_.commandSwitches();
  DriveCommand drive_command;
  drive_command.enable = power_.commanded();
  drive_command.reset = resets_;
  drive_command.home = now_.sample.state == MachineState::kHoming;
  drive_command.spindle = now_.sample.spindle_commanded;
  drive_command.coolant = now_.sample.coolant_commanded;
  Eigen::Map<Axes>(drive_command.position.data()) = now_.sample.command;
  link_.write(cycle, drive_command);
  history_.add({now_.sample.command, job_.written()});
}

void ControlLoop::publish() {
  now_.sample.feed_override = feed_override_;
  now_.sample.wheel_in_work = now_.wheel.wheel().in_work;
  now_.sample.wheel_backs_off = now_.sample.wheel_in_work && now_.wheel.backsOff(now_.sample.command[kX]);
  const bool single = jog_.inProgress() || now_.sample.state == MachineState::kLifting;
  now_.sample.distance_to_go = single ? jog_.distanceToGo() : job_.distanceToGo();

  ++now_.status.cycles;
  now_.status.time = now_.sample.time;
  now_.status.state = now_.sample.state;
  now_.status.homed = now_.sample.drive.homed;
  Eigen::Map<Axes>(now_.status.command.data()) = now_.sample.command;
  Eigen::Map<Axes>(now_.status.position.data()) = now_.sample.position;
  now_.status.feed_override = now_.sample.feed_override;
  now_.status.swivel = now_.sample.swivel;
  now_.status.probe_contact = now_.sample.drive.probe_contact;
  now_.status.setpoints_written = job_.written().setpoints;
  now_.status.wheel = now_.wheel.wheel();

  // Both are filled in before they are copied, because a copy right after a write stalls.
  if (samples_.push(now_.sample)) {
    now_.sample.job_ended = false;
  } else {
    ++now_.sample.samples_lost;  // job_ended stays set for the next sample that fits
  }
  status_.store(now_.status);
}

void ControlLoop::awaitHoming() {
  waited_ += now_.sample.period;
  homing_of_before_ &= now_.sample.drive.homing;
  homing_seen_ |= now_.sample.drive.homing && !homing_of_before_;
  const bool over = homing_seen_ && !now_.sample.drive.homing, is_fresh = now_.sample.feedback_age == 0;
  // Finding the reference may make the readings jump, but only once.
  const bool jumps_again = homing_over_ && is_fresh && !link_.isSettled();
  homing_over_ = over && (homing_over_ || is_fresh);
  const bool failed = over && (jumps_again || !now_.sample.drive.homed);
  if (jumps_again) now_.wheel.doubtY(true);
  if (homing_over_ && !failed && link_.isSettled()) {
    now_.wheel.doubtY(false);
    return now_.apply(MachineEvent::kDone);
  }
  if (!failed && waited_ <= now_.config.homing_timeout) return;
  LoopFault fault;
  fault.kind = FaultKind::kHoming;
  fault.value = waited_;
  fault.limit = now_.config.homing_timeout;
  fail(fault);
}

// ---------------------------------------------------------------------------------------------------------------------
// Motion

void ControlLoop::advance() {
  const double periods = now_.sample.period / now_.config.machine.period;
  if (moving_unbuffered_ && periods >= now_.config.late_slow_down) {
    // A delay of several periods: the axes covered only one period's distance in that time.
    job_.slowDown(1 / periods);
    now_.axis_move.slowDown(1 / periods);
    now_.limit_check.slowDown(1 / periods);
  }
  if (jog_.inProgress()) {
    jog_.stopIfNeeded();
    if (!advanceAxisMove()) return;
    jog_.end();
    // A job that was canceled meanwhile comes to rest by itself.
    if (now_.sample.state != MachineState::kCanceling) comeToRest();
  } else if (job_.inProgress()) {
    advanceJob();
  } else if (now_.sample.state == MachineState::kLifting) {
    if (!advanceAxisMove()) return;
    const AxisMove& move = now_.axis_move;
    if (move.finished() && move.axis() == kX && !move.stopping()) return beginLiftAlong(kY);
    if (move.finished() && move.axis() == kY) now_.wheel.finishLift();
    comeToRest();
  }
}

void ControlLoop::advanceJob() {
  const JobRun::Step step = job_.next(feed_override_);
  if (step == JobRun::Step::kMoves) {
    command(job_.offset());
    job_.count();
  } else if (step == JobRun::Step::kEnded || (step == JobRun::Step::kRests && job_.rest(allReachedAxes()))) {
    comeToRest();
  }
}

/// Continues a lift or a jog. @return whether it is over.
bool ControlLoop::advanceAxisMove() {
  Setpoint& setpoint = now_.sample.setpoint;
  if (!now_.axis_move.next(setpoint)) return allReachedAxes();
  if (!job_.inProgress()) {
    command();
    if (now_.sample.has_setpoint) now_.sample.job = 0;
    return false;
  }
  // The axes rest already where the move begins.
  if (setpoint.cycle == 0 && !now_.axis_move.next(setpoint)) return allReachedAxes();
  const Axes at = setpoint.position;
  job_.adopt(setpoint);
  command(job_.offset());
  job_.count();
  // Without the rounding of the conversion to work coordinates and back, an end at a limit is reached exactly.
  if (now_.sample.has_setpoint) now_.sample.command = at;
  return false;
}

/// Commands the sample's setpoint, unless it exceeds a limit.
/// @param offset machine position - position of the setpoint [m], A [rad].
void ControlLoop::command(const Axes& offset) {
  const Setpoint& setpoint = now_.sample.setpoint;
  if (const auto violation = now_.limit_check.check(setpoint, offset)) {
    LoopFault fault;
    fault.kind = FaultKind::kLimit;
    fault.axis = violation->axis;
    fault.violation = *violation;
    return fail(fault);
  }
  // The check allows for rounding beyond a limit; the command does not.
  now_.sample.command = now_.limit_check.clamped(setpoint.position + offset);
  rested_ = 0;
  now_.sample.has_setpoint = true;
}

/// Whether the last setpoint has reached the axes. It is written in every cycle, so with a buffer
/// that never empties, this is the case once it has been written as often as commands wait.
bool ControlLoop::allReachedAxes() { return now_.sample.drive.commands_waiting <= rested_++; }

void ControlLoop::comeToRest() {
  now_.apply(MachineEvent::kAtRest);
  if (power_.goesOffAtRest()) switchOff();
}

void ControlLoop::fail(const LoopFault& fault) {
  now_.sample.fault = fault;
  if (job_.inProgress()) job_.end(JobEnd::kFault);
  if (jog_.inProgress()) jog_.end();
  power_.off();
  now_.apply(MachineEvent::kFault);
}

}  // namespace grinder
