#include "flute_grinder/control/job_run.h"

#include "flute_grinder/control/drive_checks.h"

namespace grinder {

Interlock JobRun::openInterlock() const noexcept {
  const Interlock open = grinder::openInterlock(now_.sample.drive, spindle_, coolant_);
  if (open != Interlock::kNone || !stream_) return open;
  if (!now_.sample.swivel.isAt(swivel_)) return Interlock::kSwivel;
  const bool entered = in_journal_ || box_.jobInJournal() == now_.status.jobs_started;
  return entered ? Interlock::kNone : Interlock::kJournal;
}

Axes JobRun::distanceToGo() const noexcept {
  if (!stream_) return Axes::Zero();
  return stream_->program().moves()[now_.status.place.move_index].to + offset_ - now_.sample.position;
}

Refusal JobRun::begin(const JobStart& job) noexcept {
  CycleSample& sample = now_.sample;
  LoopStatus& status = now_.status;
  if (!after(sample.state, MachineEvent::kStart)) return Refusal::kState;
  if (const Refusal refusal = now_.wheel.refusal(); refusal != Refusal::kNone) return refusal;
  if (!sample.drive.homed) return Refusal::kInterlock;
  const GrindProgram& program = job.stream->program();
  const bool confirmed = job.swivel_confirmed && !sample.swivel.measured;
  if (!confirmed && !sample.swivel.isAt(program.swivel())) return Refusal::kSwivel;
  if (!(program.run().at == sample.command).all()) return Refusal::kMoved;
  stream_ = job.stream;
  swivel_ = program.swivel();
  if (confirmed) sample.swivel = status.swivel = {swivel_, false};
  offset_ = program.run().offset;
  in_journal_ = job.in_journal;
  now_.wheel.startJob(job.wheel);
  now_.limit_check.restart(program.terms());
  sample.fault = LoopFault{};
  sample.job_ended = false;  // for a previous job whose sample was lost
  status.end = JobEnd::kNone;
  status.fault = LoopFault{};
  status.place = Place{};
  status.strokes_ended_at = 0;
  written_ = JobTrack{};
  written_.job = sample.job = ++status.jobs_started;
  spindle_ = coolant_ = true;
  switched_by_hand_ = false;
  waited_ = 0;
  may_lift_off_ = true;
  now_.apply(MachineEvent::kStart);
  return Refusal::kNone;
}

Refusal JobRun::resume() noexcept {
  // A job that has not begun keeps waiting for its interlocks.
  const bool starting = now_.sample.state == MachineState::kStarting;
  if (!starting && openInterlock() != Interlock::kNone) return Refusal::kInterlock;
  now_.sample.interlock = Interlock::kNone;
  switched_by_hand_ = false;
  stream_->resume();
  now_.apply(MachineEvent::kResume);
  return Refusal::kNone;
}

Refusal JobRun::retract() noexcept {
  stream_->retract();
  now_.apply(MachineEvent::kRetract);
  return Refusal::kNone;
}

void JobRun::stop(MachineEvent event) noexcept {
  const MachineState state = now_.sample.state;
  // A wheel that is being lifted continues to the height at which a canceled job leaves it.
  const bool lifting = state == MachineState::kCanceling || state == MachineState::kRetracting;
  const bool hold = event == MachineEvent::kHold;
  if (hold || !lifting) stream_->hold();
  if (hold && state == MachineState::kCanceling) may_lift_off_ = false;
}

JobRun::Step JobRun::next(double feed_override) noexcept {
  const MachineState& state = now_.sample.state;
  if (state == MachineState::kStarting && !awaitInterlocks()) return stream_ ? Step::kWaits : Step::kEnded;
  // Before its first setpoint the job has not moved the axes.
  if (state == MachineState::kCanceling && written_.setpoints == 0) return Step::kRests;
  checkInterlocks();
  stream_->setFeedOverride(feed_override);
  bool moves = stream_->next(now_.sample.setpoint);
  if (!moves && beginLiftOff()) moves = stream_->next(now_.sample.setpoint);
  if (state == MachineState::kResuming && stream_->onPath()) now_.apply(MachineEvent::kDone);
  return moves ? Step::kMoves : Step::kRests;
}

/// @return whether the job begins in this cycle. Its first setpoint is where the axes stand.
bool JobRun::awaitInterlocks() noexcept {
  const Interlock open = openInterlock();
  if (open == Interlock::kNone) {
    now_.apply(MachineEvent::kDone);
    if (stream_->holding()) now_.apply(MachineEvent::kHold);
    return true;
  }
  waited_ += now_.sample.period;
  if (waited_ <= now_.config.spindle_timeout) return false;
  LoopFault& fault = now_.sample.fault;
  fault.kind = FaultKind::kInterlock;
  fault.interlock = open;
  fault.value = waited_;
  fault.limit = now_.config.spindle_timeout;
  end(JobEnd::kFault);
  return false;
}

void JobRun::checkInterlocks() noexcept {
  CycleSample& sample = now_.sample;
  if (sample.state == MachineState::kCanceling) return;
  const Interlock open = openInterlock();
  // A spindle or coolant that the operator has switched off is no failure; while it is off, the job is not resumed.
  const bool by_hand = switched_by_hand_ && (open == Interlock::kSpindle || open == Interlock::kCoolant);
  if (open != Interlock::kNone && !by_hand && sample.interlock == Interlock::kNone) {
    sample.interlock = open;
    // A wheel that is being lifted is moving to safety; one that was lifted is already safe.
    if (after(sample.state, MachineEvent::kHold) && sample.state != MachineState::kRetracting) {
      stream_->hold();
      now_.apply(MachineEvent::kHold);
    }
  }
  // A dwelling wheel burns the tool; a stopped or dry wheel damages it.
  if (sample.interlock != Interlock::kNone && sample.state == MachineState::kHeld) retract();
}

bool JobRun::beginLiftOff() noexcept {
  const bool in_work = now_.sample.command[kY] < now_.wheel.wheel().clear_y;
  if (now_.sample.state != MachineState::kCanceling || !may_lift_off_ || !in_work) return false;
  may_lift_off_ = false;
  stream_->retract();
  return true;
}

bool JobRun::rest(bool all_reached) noexcept {
  const MachineState state = now_.sample.state;
  const bool on_the_way = state == MachineState::kRunning || state == MachineState::kResuming;
  if (on_the_way && stream_->rest() != Rest::kEnd) return false;
  if (!all_reached) return false;
  if (on_the_way) {
    end(JobEnd::kDone);
  } else if (state == MachineState::kCanceling) {
    end(JobEnd::kCanceled);
  }
  return true;
}

void JobRun::adopt(Setpoint& setpoint) noexcept {
  setpoint.position -= offset_;
  stream_->adopt(setpoint);
}

void JobRun::end(JobEnd end) noexcept {
  stream_ = nullptr;
  spindle_ = coolant_ = false;
  now_.sample.job_ended = true;
  now_.sample.interlock = Interlock::kNone;
  ++now_.status.jobs_ended;
  now_.status.end = end;
  if (end == JobEnd::kFault) now_.status.fault = now_.sample.fault;
}

void JobRun::commandSwitches() noexcept {
  CycleSample& sample = now_.sample;
  // Without a job, a fault, lost power, homing or a lift switches off a spindle or coolant that was on by hand.
  if (!stream_ && !after(sample.state, MachineEvent::kSpindleOn)) spindle_ = coolant_ = false;
  if (!stream_ && !sample.drive.probe_free) spindle_ = false;
  sample.spindle_commanded = spindle_;
  sample.coolant_commanded = coolant_;
}

}  // namespace grinder
