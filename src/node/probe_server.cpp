#include "node/probe_server.h"

#include "flute_grinder/job/quantity.h"
#include "node/stamp_age.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

namespace flute_grinder {

namespace {

constexpr std::chrono::milliseconds kPoll(2);  ///< of the loop's status
constexpr std::uint32_t kProbeThreads = 2;
constexpr std::chrono::seconds kMaxWait(5);  ///< without a cycle

/// Why there is no result.
class ProbingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One probing move of an axis: its touches, one after the other.
class ProbingMove {
 public:
  /// @param distance the farthest, signed [m], A [rad].
  /// @param stops LoopStatus::stops when it was decided on.
  ProbingMove(ControlLoop& loop, int axis, double distance, std::uint64_t stops)
      : loop_(loop),
        config_(loop.config().probing),
        axis_(axis),
        n_(static_cast<std::size_t>(axis)),
        toward_(distance < 0 ? -1 : 1),
        begin_(loop.status().command[n_]),
        stops_(stops) {
    touch(distance, config_.velocity[axis]);
    for (int i = 0; i < config_.touches; ++i) {
      const double at = touch(2 * toward_ * config_.back_off[axis], config_.slow * config_.velocity[axis]);
      least_ = std::min(least_, at);
      most_ = std::max(most_, at);
      sum_ += at;
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

  /// Moves to the next contact, and off it. @return the axis' position at the contact.
  double touch(double distance, double velocity) {
    const double end = loop_.status().command[n_] + distance;
    const LoopStatus status = step(distance, velocity, true);
    if (!status.contact.made) {
      if (status.command[n_] != end) throw ProbingError("the axis rests before anything was touched");
      goBack();
      throw ProbingError("nothing was touched over " + shown(std::abs(distance)));
    }
    // The axis rests beyond a surface. A contact that flickers does so at one place, and its touches would agree.
    if (!status.probe_contact) throw ProbingError("the contact was lost again before the axis came to rest");
    last_touch_ = status.contact.position;
    backOff(last_touch_[n_]);
    return last_touch_[n_];
  }

  /// To where the first search began.
  void goBack() {
    const double at = loop_.status().command[n_], distance = begin_ - at;
    const LoopStatus status = step(distance, config_.velocity[axis_], false);
    if (status.command[n_] != at + distance) throw ProbingError("nothing was touched, and the way back was not free");
  }

  void backOff(double from) {
    const double at = loop_.status().command[n_];
    const double distance = from - toward_ * config_.back_off[axis_] - at;
    const LoopStatus status = step(distance, config_.velocity[axis_], false);
    if (status.command[n_] != at + distance || status.probe_contact) {
      throw ProbingError("the probe still touches, or again, within " + shown(config_.back_off[axis_]) +
                         " of the surface");
    }
  }

  /// Jogs, unless a stop came since the beginning. @return the status when the axis rests.
  LoopStatus step(double distance, double velocity, bool to_touch) {
    const std::uint64_t jog = loop_.status().jogs_begun + 1;
    const RequestReply reply = loop_.jogInSeries({axis_, false, distance, velocity, stops_, to_touch, true});
    if (!reply.answered) loop_.postStop(MachineEvent::kHold);  // it may still begin
    if (!reply.accepted) throw ProbingError(reply.text);
    const LoopStatus status = awaitEnd(jog);
    if (status.state == MachineState::kFault) throw ProbingError("the machine is in state fault");
    if (status.client_lost) {
      throw ProbingError("its client was silent for " +
                         text({loop_.config().jog_timeout, Unit::kSecond}, UnitSystem::kShop) +
                         "; ~probe_alive is to be repeated, stamped by a clock that agrees");
    }
    if (status.stops != stops_) throw ProbingError("stopped");
    if (status.jogs_begun != jog) throw ProbingError("another jog came between");
    return status;
  }

  LoopStatus awaitEnd(std::uint64_t jog) {
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

  ControlLoop& loop_;
  const ProbingConfig& config_;
  const int axis_;
  const std::size_t n_;
  const int toward_;
  const double begin_;
  const std::uint64_t stops_;
  std::array<double, kAxisCount> last_touch_{};
  double least_ = std::numeric_limits<double>::infinity(), most_ = -least_, sum_ = 0;
};

void checkRequest(const Probe::Request& request, const ControlLoop& loop, const LoopStatus& status) {
  if (!(request.axis < kAxisCount)) {
    throw ProbingError("axis = " + std::to_string(request.axis) + "; allowed: 0 to 3 for X, Y, Z, A");
  }
  if (!(request.distance != 0 && std::isfinite(request.distance))) {
    throw ProbingError("distance = " + std::to_string(request.distance) + "; allowed: finite, and not 0");
  }
  if (status.state != MachineState::kReady) {
    throw ProbingError(std::string("the machine is in state ") + toString(status.state) + "; allowed: ready");
  }
  if (!loop.config().geometry.probe) throw ProbingError("the machine has no parameter geometry/probe");
  if (!status.has_probe) throw ProbingError("the drive reads no probe");
}

}  // namespace

ProbeServer::ProbeServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate)
    : loop_(loop), gate_(gate), spinner_(kProbeThreads, &queue_) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(&queue_);
  alive_ = nh.subscribe("probe_alive", 1, &ProbeServer::onAlive, this, ros::TransportHints().tcpNoDelay());
  service_ = nh.advertiseService("probe", &ProbeServer::onProbe, this);
  spinner_.start();
}

ProbeServer::~ProbeServer() {
  service_.shutdown();
  alive_.shutdown();
  spinner_.stop();
}

bool ProbeServer::onProbe(Probe::Request& request, Probe::Response& response) {
  if (probing_.exchange(true)) {
    response.message = "probing refused: another probing move is in progress";
  } else {
    probe(request, response);
    probing_ = false;
  }
  if (!response.success) ROS_WARN_STREAM(response.message);
  return true;
}

void ProbeServer::onAlive(const std_msgs::Header::ConstPtr& message) {
  // A network that was interrupted delivers old ones.
  if (std::abs(ageOf(message->stamp)) <= loop_.config().jog_timeout) loop_.keepAlive();
}

void ProbeServer::probe(const Probe::Request& request, Probe::Response& response) {
  if (!gate_.shutOutJobs()) {
    response.message = "probing refused: a job is planned or in progress; allowed: after its end";
    return;
  }
  try {
    const LoopStatus status = loop_.status();
    checkRequest(request, loop_, status);
    response.stops = request.stops != 0 ? request.stops : status.stops;
    loop_.keepAlive();  // by its call
    const ProbingMove move(loop_, request.axis, request.distance, response.stops);
    response.position = move.mean();
    response.spread = move.spread();
    std::copy(move.lastTouch().begin(), move.lastTouch().end(), response.axes.begin());
    response.success = 1;
  } catch (const ProbingError& error) {
    response.message = std::string("probing ended: ") + error.what();
  }
  gate_.letJobsIn();
}

}  // namespace flute_grinder
