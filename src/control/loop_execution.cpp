#include "flute_grinder/control/control_loop.h"

#include <algorithm>

// Executes the requests of a cycle; all of it is real-time.
namespace grinder {

void ControlLoop::executeRequests() {
  // Taken first, executed last: a stop also stops anything requested before it.
  const StopRequests::Taken stops = stops_.take();
  if (const auto angle = swivels_.take()) swivels_.answer(answerTo(MachineEvent::kStart, setSwivel(*angle)));
  if (const auto job = job_starts_.take()) {
    Answer answer = answerTo(MachineEvent::kStart, job_.begin(*job));
    answer.job_swivel = job->stream->program().swivel();
    job_starts_.answer(answer);
  }
  if (const auto event = requests_.take()) executeRequest(*event);
  if (const auto jog = jogs_.take()) jogs_.answer(executeJog(*jog));
  if (const auto jog = series_jogs_.take()) series_jogs_.answer(executeJog(*jog));
  for (const MachineEvent stop : StopRequests::kStops) {
    if (!stops.has(stop)) continue;
    jog_.block();
    ++now_.status.stops;
    const Answer answer = answerTo(stop, execute(stop));
    if (stops.wantsReply(stop)) stops_.answer(answer);
  }
}

void ControlLoop::executeRequest(MachineEvent event) {
  const Refusal refusal = isTrigger(event) ? execute(event) : Refusal::kState;
  // Switching the power on takes time: awaitPower() answers.
  if (!power_.isAwaited()) requests_.answer(answerTo(event, refusal));
}

Answer ControlLoop::answerTo(MachineEvent event, Refusal refusal) const {
  // The spindle by hand depends on one interlock alone.
  const Interlock interlock = isSwitch(event) ? Interlock::kProbe : job_.openInterlock();
  const AxisLimits& limits = now_.config.machine.limits;
  const LiftTarget lift = liftTarget();
  const int axis = lift.y <= limits.max_position[kY] && lift.x < now_.sample.command[kX] ? kX : kY;
  Answer answer{event,
                now_.sample.state,
                refusal,
                interlock,
                axis,
                axis == kX ? lift.x : lift.y,
                axis == kX ? limits.min_position[kX] : limits.max_position[kY],
                now_.sample.swivel,
                job_.swivel(),
                {}};
  if (refusal == Refusal::kNotPrepared) answer.drive_text = power_.whyNotPrepared();
  if (refusal == Refusal::kDriveFault || refusal == Refusal::kDriveFaultStays) {
    answer.drive_text = now_.sample.drive.fault_text;
  }
  return answer;
}

Refusal ControlLoop::execute(MachineEvent event) {
  if (!driveCan(event)) return Refusal::kNotOffered;
  if (!after(now_.sample.state, event)) return Refusal::kState;
  if (isStop(event)) return executeStop(event);
  switch (event) {
    case MachineEvent::kEnable: return power_.begin(now_.sample);
    case MachineEvent::kHome: return home();
    case MachineEvent::kResume: return job_.resume();
    case MachineEvent::kRetract: return job_.retract();
    case MachineEvent::kLift: return lift();
    case MachineEvent::kReset: return reset();
    case MachineEvent::kSpindleOn:
    case MachineEvent::kSpindleOff:
    case MachineEvent::kCoolantOn:
    case MachineEvent::kCoolantOff: return switchByHand(event);
    default: return Refusal::kState;
  }
}

bool ControlLoop::driveCan(MachineEvent event) const {
  switch (event) {
    case MachineEvent::kHome: return capabilities().homing;
    case MachineEvent::kSpindleOn: return capabilities().spindle;
    case MachineEvent::kCoolantOn: return capabilities().coolant;
    // During a job nothing is switched off that could not be switched on again, or the job could not go on.
    case MachineEvent::kSpindleOff: return capabilities().spindle || !job_.inProgress();
    case MachineEvent::kCoolantOff: return capabilities().coolant || !job_.inProgress();
    default: return true;
  }
}

Refusal ControlLoop::executeStop(MachineEvent event) {
  const bool single = jog_.inProgress() || now_.sample.state == MachineState::kLifting;
  if (single || job_.inProgress()) {
    if (event == MachineEvent::kDisable) power_.offAtRest();
    if (single) {
      now_.axis_move.setSpeed(0);
    } else {
      job_.stop(event);
    }
    now_.apply(event);
  } else if (now_.sample.state != MachineState::kFault) {
    switchOff();
  }
  return Refusal::kNone;
}

Answer ControlLoop::executeJog(const JogRequest& jog) {
  Answer answer = answerTo(MachineEvent::kJog, Refusal::kNone);
  jog_.execute(jog, answer);
  return answer;
}

/// Refuses to switch on in the workpiece, where a starting wheel breaks.
Refusal ControlLoop::switchByHand(MachineEvent event) {
  const bool spindle_on = event == MachineEvent::kSpindleOn;
  if (spindle_on && jog_.isForClient()) return Refusal::kProbing;
  if (spindle_on && !now_.sample.drive.probe_free) return Refusal::kInterlock;
  const bool on = spindle_on || event == MachineEvent::kCoolantOn;
  if (const Refusal refusal = now_.wheel.refusal(); on && refusal != Refusal::kNone) return refusal;
  job_.switchByHand(spindle_on || event == MachineEvent::kSpindleOff, on);
  return Refusal::kNone;
}

void ControlLoop::awaitPower() {
  if (!power_.isAwaited()) return;
  const auto refusal = power_.await(now_.sample, link_.isSettled());
  if (!refusal) return;
  if (*refusal == Refusal::kNone) {
    drive_checks_.powerOn(now_.sample.drive);
    now_.apply(MachineEvent::kEnable);
  }
  requests_.answer(answerTo(MachineEvent::kEnable, *refusal));
}

void ControlLoop::switchOff() {
  power_.off();
  if (power_.withdraw()) requests_.answer(answerTo(MachineEvent::kEnable, Refusal::kWithdrawn));
  now_.apply(MachineEvent::kDisable);
}

Refusal ControlLoop::reset() {
  if (now_.sample.drive.emergency_stop) return Refusal::kEmergencyStop;
  resets_ = true;
  drive_checks_.reset();
  now_.sample.fault = LoopFault{};
  now_.apply(MachineEvent::kReset);
  return Refusal::kNone;
}

// ---------------------------------------------------------------------------------------------------------------------
// Motion

Refusal ControlLoop::home() {
  if (const Refusal refusal = now_.wheel.refusal(); refusal != Refusal::kNone) return refusal;
  homing_seen_ = homing_over_ = false;
  homing_of_before_ = now_.sample.drive.homing;
  waited_ = 0;
  now_.apply(MachineEvent::kHome);
  return Refusal::kNone;
}

Refusal ControlLoop::lift() {
  if (!now_.wheel.wheel().in_work) return Refusal::kNotInWork;
  const AxisLimits& limits = now_.config.machine.limits;
  const LiftTarget to = liftTarget();
  const bool backs_off = to.x < now_.sample.command[kX];
  if (!(to.y <= limits.max_position[kY])) return Refusal::kTooFar;
  if (backs_off && !(to.x >= limits.min_position[kX])) return Refusal::kTooFar;
  now_.wheel.beginLift(to);
  lift_to_ = to;
  beginLiftAlong(backs_off ? kX : kY);
  now_.apply(MachineEvent::kLift);
  return Refusal::kNone;
}

void ControlLoop::beginLiftAlong(int axis) {
  const double to = axis == kX ? lift_to_.x : std::max(now_.sample.command[kY], lift_to_.y);
  now_.axis_move.begin(MoveKind::kLift, now_.sample.command, axis, to, now_.config.machine.limits.max_velocity[axis]);
  now_.limit_check.restart();
  // A lift is allowed wherever the other axes have come to rest; without the reference their limits mean nothing.
  now_.limit_check.widen(now_.sample.command);
}

Refusal ControlLoop::setSwivel(double angle) {
  if (now_.sample.swivel.measured) return Refusal::kSwivelMeasured;
  const Swivel confirmed{angle, false};
  if (job_.inProgress() && !confirmed.isAt(job_.swivel())) return Refusal::kSwivelInUse;
  now_.sample.swivel = now_.status.swivel = confirmed;
  // Before the answer, so that a goal sent right after it finds the angle; the cycle may still wait for the drive.
  status_.store(now_.status);
  return Refusal::kNone;
}

LiftTarget ControlLoop::liftTarget() const {
  return now_.wheel.liftTarget(y_homed_, now_.sample.drive.homed, now_.sample.command);
}

}  // namespace grinder
