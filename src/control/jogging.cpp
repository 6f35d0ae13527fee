#include "flute_grinder/control/jogging.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Length of a cycle from which the whole process counts as stalled [periods].
constexpr double kStall = 20;
/// A late cycle counts as at most this many periods of a client's silence.
constexpr double kMostPeriods = 2;

}  // namespace

Axes Jogging::distanceToGo() const noexcept {
  Axes to_go = Axes::Zero();
  const int axis = now_.axis_move.axis();
  // A continuous jog has no end of its own.
  if (!(in_progress_ && continuous_)) to_go[axis] = now_.axis_move.to() - now_.sample.position[axis];
  return to_go;
}

void Jogging::execute(const JogRequest& jog, Answer& answer) noexcept {
  answer.axis = jog.axis;
  answer.refusal = jog.continuous ? goOn(jog, answer) : begin(jog, answer);
  if (jog.continuous && answer.refusal != Refusal::kNone && answer.refusal != Refusal::kJogging) block();
}

Refusal Jogging::goOn(const JogRequest& jog, Answer& answer) noexcept {
  if (jog.velocity == 0) {
    dead_man_.release();
    return Refusal::kNone;
  }
  if (dead_man_.state() == DeadMansSwitch::State::kStopped) return Refusal::kStopped;
  if (dead_man_.state() == DeadMansSwitch::State::kTimedOut) return Refusal::kTimedOut;
  if (!dead_man_.press(jog.axis)) return Refusal::kJogging;
  if (!in_progress_) return begin(jog, answer);
  AxisMove& move = now_.axis_move;
  if (!continuous_ || jog.axis != move.axis()) return Refusal::kJogging;
  if (const Refusal refusal = refusalOfSpeed(jog, answer); refusal != Refusal::kNone) return refusal;
  // A jog that is stopping, or is to reverse, first comes to rest; the messages that follow then begin a new jog.
  const bool onward = !move.stopping() && jog.velocity * move.direction() > 0;
  move.setSpeed(onward ? std::abs(jog.velocity) : 0);
  return Refusal::kNone;
}

Refusal Jogging::begin(const JogRequest& jog, Answer& answer) noexcept {
  Refusal refusal = refusalOfState(jog);
  if (refusal == Refusal::kNone) refusal = refusalOfSpeed(jog, answer);
  if (refusal == Refusal::kNone) refusal = refusalOfPosition(answer);
  const bool upward = (jog.continuous ? jog.velocity : jog.distance) > 0;
  const bool is_out = now_.wheel.isWayOut(jog.axis, upward, now_.sample.command[kX]);
  if (refusal == Refusal::kNone && !is_out) refusal = now_.wheel.refusal();
  if (refusal == Refusal::kNone) refusal = findEnd(jog, answer);
  if (refusal != Refusal::kNone) return refusal;

  const Axes& from = now_.sample.command;
  now_.axis_move.begin(MoveKind::kPosition, from, jog.axis, answer.value, std::abs(jog.velocity));
  if (job_.inProgress()) {
    // Its setpoints are computed from the machine's positions.
    Axes terms = Axes::Zero();
    terms[jog.axis] = std::max(std::abs(from[jog.axis]), std::abs(answer.value));
    now_.limit_check.addTerms(terms);
  } else {
    now_.limit_check.restart();
  }
  in_progress_ = true;
  continuous_ = jog.continuous;
  for_client_ = jog.for_client;
  now_.status.contact = {};
  now_.status.client_lost = false;
  ++now_.status.jogs_begun;
  now_.apply(MachineEvent::kJog);
  return Refusal::kNone;
}

Refusal Jogging::refusalOfState(const JogRequest& jog) const noexcept {
  const CycleSample& sample = now_.sample;
  if (!(jog.axis >= 0 && jog.axis < kAxisCount)) return Refusal::kNoAxis;
  if (!after(sample.state, MachineEvent::kJog)) return Refusal::kState;
  if (in_progress_) return Refusal::kJogging;
  if (jog.stops != 0 && jog.stops != now_.status.stops) return Refusal::kStopCameFirst;
  const bool wheel_turns = job_.spindle() || sample.spindle_commanded || sample.drive.spindle_at_speed;
  if (jog.for_client && wheel_turns) return Refusal::kWheelTurns;
  if (jog.to_touch && sample.drive.probe_contact) return Refusal::kTouches;
  if (!job_.allowsJog()) return Refusal::kJobOver;
  return sample.drive.homed ? Refusal::kNone : Refusal::kInterlock;
}

Refusal Jogging::refusalOfSpeed(const JogRequest& jog, Answer& answer) const noexcept {
  answer.value = jog.continuous ? std::abs(jog.velocity) : jog.velocity;
  answer.limit = now_.config.machine.limits.max_velocity[jog.axis];
  return answer.value > 0 && answer.value <= answer.limit ? Refusal::kNone : Refusal::kJogSpeed;
}

Refusal Jogging::refusalOfPosition(Answer& answer) const noexcept {
  const AxisLimits& limits = now_.config.machine.limits;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const double at = now_.sample.command[axis];
    if (at >= limits.min_position[axis] && at <= limits.max_position[axis]) continue;
    answer.axis = axis;
    answer.value = at;
    answer.limit = at < limits.min_position[axis] ? limits.min_position[axis] : limits.max_position[axis];
    return Refusal::kOutside;
  }
  return Refusal::kNone;
}

/// @param answer gets the end as its value.
Refusal Jogging::findEnd(const JogRequest& jog, Answer& answer) const noexcept {
  const double from = now_.sample.command[jog.axis];
  const bool down = (jog.continuous ? jog.velocity : jog.distance) < 0;
  answer.limit = down ? lowest(jog.axis) : now_.config.machine.limits.max_position[jog.axis];
  answer.value = jog.continuous ? answer.limit : from + jog.distance;
  if (jog.continuous && (down ? from <= answer.limit : from >= answer.limit)) return Refusal::kAtLimit;
  // The distance to the limit was rounded by the client, and the sum is rounded here.
  const double rounding = kEpsilon / 2 * (std::abs(from) + 2 * std::abs(answer.limit));
  if (std::abs(answer.value - answer.limit) <= rounding) answer.value = answer.limit;
  const bool within = down ? answer.value >= answer.limit : answer.value <= answer.limit;
  return within ? Refusal::kNone : Refusal::kTooFar;
}

double Jogging::lowest(int axis) const noexcept {
  const double lowest = now_.config.machine.limits.min_position[axis];
  // In the middle of a job the wheel stays off the workpiece.
  return axis == kY && job_.inProgress() ? std::max(lowest, now_.wheel.wheel().clear_y) : lowest;
}

void Jogging::watch() noexcept {
  touches_ = now_.sample.drive.probe_contact && !touched_;
  touched_ = now_.sample.drive.probe_contact;
  // A late loop has not heard the clients meanwhile. After a stall of the whole process, their messages still wait to
  // be read by threads that need a processor first.
  const double periods = now_.sample.period / now_.config.machine.period;
  if (periods > kStall) {
    dead_man_.forgive();
    client_.forgive();
  }
  const double unheard = std::min(periods, kMostPeriods) * now_.config.machine.period;
  dead_man_.wait(unheard);
  client_.wait(unheard);
  hearClient();
}

void Jogging::hearClient() noexcept {
  const std::uint32_t keep_alives = box_.keepAlives();
  if (keep_alives != keep_alives_seen_) client_.restart();
  keep_alives_seen_ = keep_alives;
}

void Jogging::stopIfNeeded() noexcept {
  const CycleSample& sample = now_.sample;
  LoopStatus& status = now_.status;
  bool stops = false;
  // A jog that begins in contact moves the probe away: only a new contact stops it.
  if (touches_ && !status.contact.made) {
    status.contact.made = stops = true;
    Eigen::Map<Axes>(status.contact.position.data()) = sample.position;
    dead_man_.block();
  }
  hearClient();  // again: a jog may have been requested in this cycle, after its client was heard
  if (for_client_ && client_.expired()) {
    for_client_ = false;
    status.client_lost = stops = true;
    ++status.stops;  // so that the series ends too
  }
  // Without the reference the limits mean nothing.
  if (!sample.drive.homed) dead_man_.block();
  const bool released = continuous_ && dead_man_.state() != DeadMansSwitch::State::kPressed;
  if (stops || released || !sample.drive.homed) now_.axis_move.setSpeed(0);
}

void Jogging::end() noexcept {
  in_progress_ = false;
  ++now_.status.jogs_ended;
}

}  // namespace grinder
