#include "flute_grinder/node/probe_desk.h"

#include "flute_grinder/core/quantity.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

namespace flute_grinder {

namespace {

constexpr std::chrono::milliseconds kPoll(2);    ///< of the loop's status
constexpr std::chrono::seconds kLoopTimeout(5);  ///< without a cycle

/// Why there is no result.
class ProbingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One probing move of an axis: its touches, one after the other.
class ProbingMove {
 public:
  /// @param distance the farthest, signed [m], A [rad].
  ProbingMove(ControlLoop& loop, int axis, double distance)
      : loop_(loop),
        config_(loop.config().probing),
        axis_(axis),
        n_(static_cast<std::size_t>(axis)),
        toward_(distance < 0 ? -1 : 1),
        stops_(loop.status().stops) {
    backOff(touch(distance, config_.velocity[axis]));
    for (int i = 0; i < config_.touches; ++i) {
      const double at = touch(2 * toward_ * config_.back_off[axis], config_.slow * config_.velocity[axis]);
      least_ = std::min(least_, at);
      most_ = std::max(most_, at);
      sum_ += at;
      backOff(at);
    }
    if (!(spread() <= config_.largest_spread[axis])) {
      throw ProbingError("the touches spread over " + shown(spread()) + "; allowed: up to " +
                         shown(config_.largest_spread[axis]));
    }
  }

  double mean() const { return sum_ / config_.touches; }
  double spread() const { return most_ - least_; }
  const std::array<double, kAxisCount>& lastTouch() const { return last_touch_; }

 private:
  std::string shown(double si) const { return text({si, unitOf(axis_, 0)}, UnitSystem::kShop); }

  /// Moves to the next contact. @return the axis' position there.
  double touch(double distance, double velocity) {
    if (loop_.status().probe_contact) throw ProbingError("the probe touches already; move it off first");
    const double end = loop_.status().command[n_] + distance;
    const LoopStatus status = step(distance, velocity);
    if (!status.contact.made) {
      throw ProbingError(status.command[n_] == end ? "nothing was touched over " + shown(std::abs(distance))
                                                   : "stopped before anything was touched");
    }
    last_touch_ = status.contact.position;
    return last_touch_[n_];
  }

  void backOff(double from) {
    const double to = from - toward_ * config_.back_off[axis_];
    if (step(to - loop_.status().command[n_], config_.velocity[axis_]).probe_contact) {
      throw ProbingError("the probe still touches, " + shown(config_.back_off[axis_]) + " off the surface");
    }
  }

  /// Jogs, unless a stop came since the beginning. @return the status when the axis rests.
  LoopStatus step(double distance, double velocity) {
    const std::uint64_t ended = loop_.status().jogs_ended;
    const RequestReply reply = loop_.jogInSeries({axis_, false, distance, velocity, stops_});
    if (!reply.accepted) throw ProbingError(reply.text);
    const LoopStatus status = awaitEnd(ended + 1);
    if (status.jogs_ended != ended + 1) throw ProbingError("another jog came between");
    if (status.state == MachineState::kFault) throw ProbingError("the machine is in state fault");
    return status;
  }

  LoopStatus awaitEnd(std::uint64_t jogs) {
    LoopStatus status = loop_.status();
    auto alive = std::chrono::steady_clock::now();
    while (status.jogs_ended < jogs) {
      std::this_thread::sleep_for(kPoll);
      const LoopStatus next = loop_.status();
      const auto now = std::chrono::steady_clock::now();
      if (next.cycles != status.cycles) alive = now;
      if (now - alive > kLoopTimeout) throw ProbingError("the control loop has stopped");
      status = next;
    }
    return status;
  }

  ControlLoop& loop_;
  const ProbingConfig& config_;
  const int axis_;
  const std::size_t n_;
  const int toward_;
  const std::uint64_t stops_;
  std::array<double, kAxisCount> last_touch_{};
  double least_ = std::numeric_limits<double>::infinity(), most_ = -least_, sum_ = 0;
};

void checkRequest(const Probe::Request& request, const LoopStatus& status) {
  if (!(request.axis < kAxisCount)) {
    throw ProbingError("axis = " + std::to_string(request.axis) + "; allowed: 0 to 3 for X, Y, Z, A");
  }
  if (!(request.distance != 0 && std::isfinite(request.distance))) {
    throw ProbingError("distance = " + std::to_string(request.distance) + "; allowed: finite, and not 0");
  }
  if (status.state != MachineState::kReady) {
    throw ProbingError(std::string("the machine is in state ") + toString(status.state) + "; allowed: ready");
  }
}

}  // namespace

ProbeDesk::ProbeDesk(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate) : loop_(loop), gate_(gate) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  service_ = nh.advertiseService("probe", &ProbeDesk::onProbe, this);
  thread_.start();
}

bool ProbeDesk::onProbe(Probe::Request& request, Probe::Response& response) {
  response.success = 0;
  if (!gate_.shutOutJobs()) {
    response.message = "probing refused: a job is in progress; allowed: after its end";
  } else {
    try {
      checkRequest(request, loop_.status());
      const ProbingMove move(loop_, request.axis, request.distance);
      response.position = move.mean();
      response.spread = move.spread();
      std::copy(move.lastTouch().begin(), move.lastTouch().end(), response.axes.begin());
      response.success = 1;
    } catch (const ProbingError& error) {
      response.message = std::string("probing ended: ") + error.what();
    }
    gate_.letJobsIn();
  }
  if (!response.success) ROS_WARN_STREAM(response.message);
  return true;
}

}  // namespace flute_grinder
