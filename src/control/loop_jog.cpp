#include "flute_grinder/control/control_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Jogs: their requests and their motion; all of it is real-time.
namespace grinder {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Length of a cycle from which the whole process counts as stalled [periods].
constexpr double kStall = 20;
/// A late cycle counts as at most this many periods of a client's silence.
constexpr double kMostPeriods = 2;

}  // namespace

Answer ControlLoop::executeJog(const JogRequest& jog) {
  Answer answer = answerTo(MachineEvent::kJog, Refusal::kNone);
  answer.axis = jog.axis;
  answer.refusal = jog.continuous ? jogOn(jog, answer) : beginJog(jog, answer);
  if (jog.continuous && answer.refusal != Refusal::kNone && answer.refusal != Refusal::kJogging) dead_man_.block();
  return answer;
}

Refusal ControlLoop::jogOn(const JogRequest& jog, Answer& answer) {
  if (jog.velocity == 0) {
    dead_man_.release();
    return Refusal::kNone;
  }
  if (dead_man_.state() == DeadMansSwitch::State::kStopped) return Refusal::kStopped;
  if (dead_man_.state() == DeadMansSwitch::State::kTimedOut) return Refusal::kTimedOut;
  if (!dead_man_.press(jog.axis)) return Refusal::kJogging;
  if (!jogging_) return beginJog(jog, answer);
  if (!continuous_ || jog.axis != axis_move_.axis()) return Refusal::kJogging;
  if (const Refusal refusal = refusalOfSpeed(jog, answer); refusal != Refusal::kNone) return refusal;
  // A jog that is stopping, or is to reverse, first comes to rest; the messages that follow then begin a new jog.
  const bool onward = !axis_move_.stopping() && jog.velocity * axis_move_.direction() > 0;
  axis_move_.setSpeed(onward ? std::abs(jog.velocity) : 0);
  return Refusal::kNone;
}

Refusal ControlLoop::beginJog(const JogRequest& jog, Answer& answer) {
  if (!(jog.axis >= 0 && jog.axis < kAxisCount)) return Refusal::kNoAxis;
  if (!after(state_, MachineEvent::kJog)) return Refusal::kState;
  if (jogging_) return Refusal::kJogging;
  if (jog.stops != 0 && jog.stops != next_status_.stops) return Refusal::kStopCameFirst;
  const bool wheel_turns = spindle_ || sample_.spindle_commanded || sample_.drive.spindle_at_speed;
  if (jog.for_client && wheel_turns) return Refusal::kWheelTurns;
  if (jog.to_touch && sample_.drive.probe_contact) return Refusal::kTouches;
  if (stream_ && stream_->rest() != Rest::kLifted) return Refusal::kJobOver;
  if (!sample_.drive.homed) return Refusal::kInterlock;
  if (const Refusal refusal = refusalOfSpeed(jog, answer); refusal != Refusal::kNone) return refusal;
  if (const Refusal refusal = refusalOfPosition(answer); refusal != Refusal::kNone) return refusal;
  const double way = jog.continuous ? jog.velocity : jog.distance;
  const bool raises = jog.axis == kY && way > 0;
  if (const Refusal refusal = refusalOfWheel(); !raises && refusal != Refusal::kNone) return refusal;

  const double from = command_[jog.axis];
  answer.limit = way < 0 ? lowestJog(jog.axis) : config_.machine.limits.max_position[jog.axis];
  answer.value = jog.continuous ? answer.limit : from + jog.distance;
  if (jog.continuous && (way < 0 ? from <= answer.limit : from >= answer.limit)) return Refusal::kAtLimit;
  // The distance to the limit was rounded by the client, and the sum is rounded here.
  const double rounding = kEpsilon / 2 * (std::abs(from) + 2 * std::abs(answer.limit));
  if (std::abs(answer.value - answer.limit) <= rounding) answer.value = answer.limit;
  const bool within = way < 0 ? answer.value >= answer.limit : answer.value <= answer.limit;
  if (!within) return Refusal::kTooFar;

  axis_move_.begin(MoveKind::kPosition, command_, jog.axis, answer.value, std::abs(jog.velocity));
  if (stream_) {
    // Its setpoints are computed from the machine's positions.
    Axes terms = Axes::Zero();
    terms[jog.axis] = std::max(std::abs(from), std::abs(answer.value));
    limit_check_.addTerms(terms);
  } else {
    limit_check_.restart();
  }
  jogging_ = true;
  continuous_ = jog.continuous;
  for_client_ = jog.for_client;
  next_status_.contact = {};
  next_status_.client_lost = false;
  ++next_status_.jogs_begun;
  apply(MachineEvent::kJog);
  return Refusal::kNone;
}

Refusal ControlLoop::refusalOfSpeed(const JogRequest& jog, Answer& answer) const {
  answer.value = jog.continuous ? std::abs(jog.velocity) : jog.velocity;
  answer.limit = config_.machine.limits.max_velocity[jog.axis];
  return answer.value > 0 && answer.value <= answer.limit ? Refusal::kNone : Refusal::kJogSpeed;
}

Refusal ControlLoop::refusalOfPosition(Answer& answer) const {
  const AxisLimits& limits = config_.machine.limits;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const double at = command_[axis];
    if (at >= limits.min_position[axis] && at <= limits.max_position[axis]) continue;
    answer.axis = axis;
    answer.value = at;
    answer.limit = at < limits.min_position[axis] ? limits.min_position[axis] : limits.max_position[axis];
    return Refusal::kOutside;
  }
  return Refusal::kNone;
}

double ControlLoop::lowestJog(int axis) const {
  const double lowest = config_.machine.limits.min_position[axis];
  // In the middle of a job the wheel stays off the workpiece.
  return axis == kY && stream_ ? std::max(lowest, wheel_.wheel().clear_y) : lowest;
}

void ControlLoop::watchClients() {
  // A late loop has not heard the clients meanwhile. After a stall of the whole process, their messages still wait to
  // be read by threads that need a processor first.
  const double periods = sample_.period / config_.machine.period;
  if (periods > kStall) {
    dead_man_.forgive();
    client_.forgive();
  }
  const double unheard = std::min(periods, kMostPeriods) * config_.machine.period;
  dead_man_.wait(unheard);
  client_.wait(unheard);
  hearClient();
}

void ControlLoop::hearClient() {
  const std::uint32_t keep_alives = keepAlives();
  if (keep_alives != keep_alives_seen_) client_.restart();
  keep_alives_seen_ = keep_alives;
}

void ControlLoop::advanceJog() {
  stopJogOnContact();
  stopJogWithoutClient();
  // Without the reference the limits mean nothing.
  if (!sample_.drive.homed) dead_man_.block();
  const bool released = continuous_ && dead_man_.state() != DeadMansSwitch::State::kPressed;
  if (released || !sample_.drive.homed) axis_move_.setSpeed(0);
  if (!advanceAxisMove()) return;
  endJog();
  // A job that was canceled meanwhile comes to rest by itself.
  if (state_ != MachineState::kCanceling) comeToRest();
}

void ControlLoop::stopJogOnContact() {
  // A jog that begins in contact moves the probe away: only a new contact stops it.
  const bool begins = sample_.drive.probe_contact && !touched_;
  if (!begins || next_status_.contact.made) return;
  next_status_.contact.made = true;
  std::copy(sample_.position.data(), sample_.position.data() + kAxisCount, next_status_.contact.position.begin());
  dead_man_.block();
  axis_move_.setSpeed(0);
}

/// Counts as a stop, so that the series ends too.
void ControlLoop::stopJogWithoutClient() {
  hearClient();  // again: a jog may have been requested in this cycle, after its client was heard
  if (!for_client_ || !client_.expired()) return;
  for_client_ = false;
  next_status_.client_lost = true;
  ++next_status_.stops;
  axis_move_.setSpeed(0);
}

void ControlLoop::endJog() {
  jogging_ = false;
  ++next_status_.jogs_ended;
}

}  // namespace grinder
