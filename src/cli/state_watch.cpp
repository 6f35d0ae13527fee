#include "cli/state_watch.h"

#include "flute_grinder/machine/machine_state.h"

namespace grinder {

namespace {

const ros::WallDuration kTimeout(3);

}  // namespace

const char* const kLinkLost =
    "the connection to the grinder is lost: no message for 3 s; the state of the machine is unknown";

bool inJob(const flute_grinder::GrinderState& state) { return isInJob(static_cast<MachineState>(state.state)); }

StateWatch::StateWatch(ros::NodeHandle& nh) {
  const boost::function<void(const flute_grinder::GrinderState::ConstPtr&)> on_state =
      [this](const flute_grinder::GrinderState::ConstPtr& state) {
        const std::lock_guard<std::mutex> lock(mutex_);
        newest_ = *state;
        time_ = ros::SteadyTime::now();
        ++heard_;
      };
  subscriber_ = nh.subscribe<flute_grinder::GrinderState>("state", 10, on_state);
}

bool StateWatch::awaitNext() const {
  // The first two states may have been sent before the call.
  const std::uint64_t enough = heard() + 3;
  return await(kTimeout, [&] { return heard() >= enough; });
}

flute_grinder::GrinderState StateWatch::newest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_;
}

std::uint64_t StateWatch::heard() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return heard_;
}

bool StateWatch::lost() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !ros::ok() || ros::SteadyTime::now() - time_ > kTimeout;
}

}  // namespace grinder
