#include "flute_grinder/control/control_loop.h"

#include <algorithm>

// Executes the requests of a cycle; all of it is real-time.
namespace grinder {

void ControlLoop::executeRequests() {
  // Taken first, executed last: a stop also stops anything requested before it.
  const StopRequests::Taken stops = stops_.take();
  if (const auto angle = swivels_.take()) swivels_.answer(answerTo(MachineEvent::kStart, setSwivel(*angle)));
  if (const auto job = job_starts_.take()) {
    Answer answer = answerTo(MachineEvent::kStart, beginJob(*job));
    answer.job_swivel = job->stream->program().swivel();
    job_starts_.answer(answer);
  }
  if (const auto event = requests_.take()) executeRequest(*event);
  if (const auto jog = jogs_.take()) jogs_.answer(executeJog(*jog));
  if (const auto jog = series_jogs_.take()) series_jogs_.answer(executeJog(*jog));
  for (const MachineEvent stop : StopRequests::kStops) {
    if (!stops.has(stop)) continue;
    dead_man_.block();
    ++next_status_.stops;
    const Answer answer = answerTo(stop, execute(stop));
    if (stops.wantsReply(stop)) stops_.answer(answer);
  }
}

void ControlLoop::executeRequest(MachineEvent event) {
  const Refusal refusal = isTrigger(event) ? execute(event) : Refusal::kState;
  // Switching the power on takes time: awaitPower() answers.
  if (!awaiting_power_) requests_.answer(answerTo(event, refusal));
}

Answer ControlLoop::answerTo(MachineEvent event, Refusal refusal) const {
  // The spindle by hand depends on one interlock alone.
  const Interlock interlock = isSwitch(event) ? Interlock::kProbe : openInterlock();
  Answer answer{
      event,          state_,      refusal, interlock, kY, liftTarget(), config_.machine.limits.max_position[kY],
      sample_.swivel, job_swivel_, {}};
  if (refusal == Refusal::kNotPrepared) answer.drive_text = preparation_->why();
  if (refusal == Refusal::kDriveFault || refusal == Refusal::kDriveFaultStays) {
    answer.drive_text = sample_.drive.fault_text;
  }
  return answer;
}

Refusal ControlLoop::execute(MachineEvent event) {
  if (!driveCan(event)) return Refusal::kNotOffered;
  if (!after(state_, event)) return Refusal::kState;
  if (isStop(event)) return executeStop(event);
  switch (event) {
    case MachineEvent::kEnable: return enable();
    case MachineEvent::kHome: return home();
    case MachineEvent::kResume: return resume();
    case MachineEvent::kRetract: return retract();
    case MachineEvent::kLift: return lift();
    case MachineEvent::kReset: return reset();
    case MachineEvent::kSpindleOn: return spindleOn();
    case MachineEvent::kSpindleOff: return switchByHand(spindle_, false);
    case MachineEvent::kCoolantOn: return switchByHand(coolant_, true);
    case MachineEvent::kCoolantOff: return switchByHand(coolant_, false);
    default: return Refusal::kState;
  }
}

bool ControlLoop::driveCan(MachineEvent event) const {
  switch (event) {
    case MachineEvent::kHome: return capabilities_.homing;
    case MachineEvent::kSpindleOn: return capabilities_.spindle;
    case MachineEvent::kCoolantOn: return capabilities_.coolant;
    // During a job nothing is switched off that could not be switched on again, or the job could not go on.
    case MachineEvent::kSpindleOff: return capabilities_.spindle || !stream_;
    case MachineEvent::kCoolantOff: return capabilities_.coolant || !stream_;
    default: return true;
  }
}

Refusal ControlLoop::executeStop(MachineEvent event) {
  const bool off = event == MachineEvent::kDisable;
  if (jogging_ || state_ == MachineState::kLifting) {
    power_off_next_ |= off;
    axis_move_.setSpeed(0);
  } else if (stream_) {
    power_off_next_ |= off;
    // A wheel that is being lifted continues to the height at which a canceled job leaves it.
    const bool lifting = state_ == MachineState::kCanceling || state_ == MachineState::kRetracting;
    const bool hold = event == MachineEvent::kHold;
    if (hold || !lifting) stream_->hold();
    if (hold && state_ == MachineState::kCanceling) may_lift_off_ = false;
  } else if (state_ == MachineState::kFault) {
    return Refusal::kNone;
  } else {
    switchOff();
    return Refusal::kNone;
  }
  apply(event);
  return Refusal::kNone;
}

// ---------------------------------------------------------------------------------------------------------------------
// Power

Refusal ControlLoop::enable() {
  const Refusal refusal = drive_checks_.powerRefusal(sample_);
  if (refusal != Refusal::kNone || isPowered(state_)) return refusal;
  awaiting_power_ = true;
  preparation_begun_ = false;
  waited_ = 0;
  return Refusal::kNone;
}

Refusal ControlLoop::spindleOn() {
  if (jogging_ && for_client_) return Refusal::kProbing;
  return sample_.drive.probe_free ? switchByHand(spindle_, true) : Refusal::kInterlock;
}

/// Refuses to switch on in the workpiece, where a starting wheel breaks. @param commanded spindle_ or coolant_.
Refusal ControlLoop::switchByHand(bool& commanded, bool on) {
  if (const Refusal refusal = refusalOfWheel(); on && refusal != Refusal::kNone) return refusal;
  commanded = on;
  switched_by_hand_ = true;
  return Refusal::kNone;
}

void ControlLoop::awaitPower() {
  if (!awaiting_power_) return;
  waited_ += sample_.period;
  // While two readings disagree, the position of the axes is unknown, and no power is commanded.
  drive_command_.enable &= settled_;
  const bool on = drive_command_.enable && sample_.drive.enabled;
  Refusal refusal = drive_checks_.powerRefusal(sample_);
  if (refusal == Refusal::kNone) refusal = commandPower();
  if (refusal == Refusal::kNone && !on && !(waited_ <= config_.enable_timeout)) refusal = refusalWithoutPower();
  if (refusal != Refusal::kNone) {
    drive_command_.enable = false;
    answerEnable(refusal);
  } else if (on) {
    drive_checks_.powerOn(sample_.drive);
    apply(MachineEvent::kEnable);
    answerEnable(Refusal::kNone);
  }
}

/// Commands the power once the earlier power is off, which could be taken for the new, the drive is prepared and the
/// command is where the axes are.
Refusal ControlLoop::commandPower() {
  if (drive_command_.enable || sample_.drive.enabled) return Refusal::kNone;
  if (preparation_ && !preparation_begun_) {
    if (!preparation_->begin()) return Refusal::kPreparing;
    preparation_begun_ = true;
  }
  if (isPreparing() || !settled_) return Refusal::kNone;
  drive_command_.enable = !preparation_ || preparation_->state() == DrivePreparation::State::kReady;
  return drive_command_.enable ? Refusal::kNone : Refusal::kNotPrepared;
}

Refusal ControlLoop::refusalWithoutPower() const {
  if (!settled_) return Refusal::kFeedback;
  if (drive_command_.enable) return Refusal::kNoPower;
  return isPreparing() ? Refusal::kPreparing : Refusal::kPowerStays;
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

Refusal ControlLoop::reset() {
  if (sample_.drive.emergency_stop) return Refusal::kEmergencyStop;
  drive_command_.reset = true;
  drive_checks_.reset();
  sample_.fault = LoopFault{};
  apply(MachineEvent::kReset);
  return Refusal::kNone;
}

// ---------------------------------------------------------------------------------------------------------------------
// Motion

Refusal ControlLoop::home() {
  if (const Refusal refusal = refusalOfWheel(); refusal != Refusal::kNone) return refusal;
  homing_seen_ = homing_over_ = false;
  homing_of_before_ = sample_.drive.homing;
  waited_ = 0;
  apply(MachineEvent::kHome);
  return Refusal::kNone;
}

/// @return why only a lift may move the wheel; kNone if any motion may.
Refusal ControlLoop::refusalOfWheel() const {
  if (!wheel_.wheel().in_work) return Refusal::kNone;
  return wheel_.wheel().known ? Refusal::kInWork : Refusal::kMayBeInWork;
}

Refusal ControlLoop::beginJob(const JobStart& job) {
  if (!after(state_, MachineEvent::kStart)) return Refusal::kState;
  if (const Refusal refusal = refusalOfWheel(); refusal != Refusal::kNone) return refusal;
  if (!sample_.drive.homed) return Refusal::kInterlock;
  const GrindProgram& program = job.stream->program();
  const bool confirmed = job.swivel_confirmed && !sample_.swivel.measured;
  if (!confirmed && !sample_.swivel.isAt(program.swivel())) return Refusal::kSwivel;
  if (!(program.run().at == command_).all()) return Refusal::kMoved;
  stream_ = job.stream;
  job_swivel_ = program.swivel();
  if (confirmed) sample_.swivel = next_status_.swivel = {job_swivel_, false};
  job_offset_ = program.run().offset;
  in_journal_ = job.in_journal;
  wheel_.startJob(job.wheel);
  limit_check_.restart(program.terms());
  sample_.fault = LoopFault{};
  sample_.interlock = Interlock::kNone;
  sample_.job_ended = false;  // for a previous job whose sample was lost
  next_status_.end = JobEnd::kNone;
  next_status_.fault = LoopFault{};
  next_status_.place = Place{};
  next_status_.strokes_ended_at = 0;
  written_ = JobTrack{};
  written_.job = sample_.job = ++next_status_.jobs_started;
  spindle_ = coolant_ = true;
  switched_by_hand_ = false;
  waited_ = 0;
  may_lift_off_ = true;
  apply(MachineEvent::kStart);
  return Refusal::kNone;
}

Refusal ControlLoop::resume() {
  // A job that has not begun keeps waiting for its interlocks.
  const bool starting = state_ == MachineState::kStarting;
  if (!starting && openInterlock() != Interlock::kNone) return Refusal::kInterlock;
  sample_.interlock = Interlock::kNone;
  switched_by_hand_ = false;
  stream_->resume();
  apply(MachineEvent::kResume);
  return Refusal::kNone;
}

Refusal ControlLoop::retract() {
  stream_->retract();
  apply(MachineEvent::kRetract);
  return Refusal::kNone;
}

Refusal ControlLoop::lift() {
  if (!wheel_.wheel().in_work) return Refusal::kNotInWork;
  if (!(liftTarget() <= config_.machine.limits.max_position[kY])) return Refusal::kTooFar;
  const double to = std::max(command_[kY], liftTarget());
  wheel_.beginLift(to);
  axis_move_.begin(MoveKind::kLift, command_, kY, to, config_.machine.limits.max_velocity[kY]);
  limit_check_.restart();
  // A lift is allowed wherever the other axes have come to rest; without the reference their limits mean nothing.
  limit_check_.widen(command_);
  apply(MachineEvent::kLift);
  return Refusal::kNone;
}

Refusal ControlLoop::setSwivel(double angle) {
  if (sample_.swivel.measured) return Refusal::kSwivelMeasured;
  const Swivel confirmed{angle, false};
  if (stream_ && !confirmed.isAt(job_swivel_)) return Refusal::kSwivelInUse;
  sample_.swivel = next_status_.swivel = confirmed;
  // Before the answer, so that a goal sent right after it finds the angle; the cycle may still wait for the drive.
  status_.store(next_status_);
  return Refusal::kNone;
}

double ControlLoop::liftTarget() const { return wheel_.liftTarget(sample_.drive.homed, command_[kY]); }

}  // namespace grinder
