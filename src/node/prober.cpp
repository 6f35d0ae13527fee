#include "node/prober.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

namespace grinder {

namespace {

constexpr std::chrono::milliseconds kPoll(2);  ///< interval between looks at the loop's status
constexpr std::chrono::seconds kMaxWait(5);    ///< longest wait without a cycle of the loop

std::size_t index(int axis) { return static_cast<std::size_t>(axis); }

}  // namespace

std::string shownOf(int axis, double si) { return text(Quantity{si, unitOf(axis, 0)}); }

Prober::Prober(ControlLoop& loop, std::uint64_t stops, std::function<void(int, int)> on_touch)
    : loop_(loop), stops_(stops), on_touch_(std::move(on_touch)) {}

Prober::Touch Prober::touch(int axis, double distance) {
  const ProbingConfig& probing = config().probing;
  const Search search{axis, distance < 0 ? -1.0 : 1.0, loop_.status().command[index(axis)]};
  on_touch_(places_, 0);
  touchOnce(search, distance, probing.velocity[axis]);
  Touch result;
  double min = std::numeric_limits<double>::infinity(), max = -min, sum = 0;
  for (int i = 0; i < probing.touches; ++i) {
    on_touch_(places_, i + 1);
    const double way = 2 * search.toward * probing.back_off[axis];
    result.axes = touchOnce(search, way, probing.slow * probing.velocity[axis]).contact.position;
    const double at = result.axes[index(axis)];
    min = std::min(min, at);
    max = std::max(max, at);
    sum += at;
  }
  ++places_;
  result.axes[index(axis)] = sum / probing.touches;
  result.spread = max - min;
  if (!(result.spread <= probing.max_spread[axis])) {
    throw ProbingError("the touches spread over " + shownOf(axis, result.spread) + "; allowed: up to " +
                       shownOf(axis, probing.max_spread[axis]));
  }
  return result;
}

void Prober::turn(double angle) {
  const double end = loop_.status().command[kA] + angle;
  const LoopStatus status = step(kA, angle, config().jog_velocity[kA], false);
  if (status.command[kA] != end) throw ProbingError("A was stopped before its end");
}

void Prober::checkStop() const {
  if (loop_.status().stops != stops_) throw ProbingError("stopped");
}

/// Moves to the next contact, and off it. @return the status when the axis had come to rest beyond the contact.
LoopStatus Prober::touchOnce(const Search& search, double distance, double velocity) {
  const std::size_t n = index(search.axis);
  const double end = loop_.status().command[n] + distance;
  const LoopStatus status = step(search.axis, distance, velocity, true);
  if (!status.contact.made) {
    if (status.command[n] != end) throw ProbingError("the axis rests before anything was touched");
    goBack(search);
    throw ProbingError("nothing was touched over " + shownOf(search.axis, std::abs(distance)));
  }
  // A true contact lasts, because the axis rests beyond the surface. A contact that flickers does so at one place, so
  // its touches would agree.
  if (!status.probe_contact) throw ProbingError("the contact was lost again before the axis came to rest");
  backOff(search, status.contact.position[n]);
  return status;
}

/// Moves back to where the first search began.
void Prober::goBack(const Search& search) {
  const double at = loop_.status().command[index(search.axis)], distance = search.begin - at;
  const LoopStatus status = step(search.axis, distance, config().probing.velocity[search.axis], false);
  if (status.command[index(search.axis)] != at + distance) {
    throw ProbingError("nothing was touched, and the way back was not free");
  }
}

void Prober::backOff(const Search& search, double from) {
  const double at = loop_.status().command[index(search.axis)], off = config().probing.back_off[search.axis];
  const double distance = from - search.toward * off - at;
  const LoopStatus status = step(search.axis, distance, config().probing.velocity[search.axis], false);
  if (status.command[index(search.axis)] != at + distance || status.probe_contact) {
    throw ProbingError("the probe still touches, or again, within " + shownOf(search.axis, off) + " of the surface");
  }
}

/// Jogs, unless a stop came since the beginning. @return the status when the axis rests.
LoopStatus Prober::step(int axis, double distance, double velocity, bool to_touch) {
  checkStop();
  const std::uint64_t jog = loop_.status().jogs_begun + 1;
  const RequestReply reply = loop_.jogInSeries({axis, false, distance, velocity, stops_, to_touch, true});
  if (!reply.answered) loop_.postStop(MachineEvent::kHold);  // the jog may still begin
  if (!reply.accepted) throw ProbingError(reply.text);
  const LoopStatus status = awaitEnd(jog);
  if (status.state == MachineState::kFault) throw ProbingError("the machine is in state fault");
  if (status.client_lost) {
    throw ProbingError("its client was silent for " + text(Quantity{config().jog_timeout, Unit::kSecond}) +
                       "; ~probe_alive is to be repeated, stamped by a clock that agrees");
  }
  if (status.stops != stops_) throw ProbingError("stopped");
  if (status.jogs_begun != jog) throw ProbingError("another jog came between");
  return status;
}

LoopStatus Prober::awaitEnd(std::uint64_t jog) {
  LoopStatus status = loop_.status();
  auto alive = std::chrono::steady_clock::now();
  while (status.jogs_ended < jog) {
    std::this_thread::sleep_for(kPoll);
    const LoopStatus next = loop_.status();
    const auto now = std::chrono::steady_clock::now();
    if (next.cycles != status.cycles) alive = now;
    if (now - alive > kMaxWait) {
      loop_.postStop(MachineEvent::kHold);
      throw ProbingError("the control loop has stopped");
    }
    status = next;
  }
  return status;
}

}  // namespace grinder
