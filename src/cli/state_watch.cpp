#include "cli/state_watch.h"

#include "flute_grinder/machine/machine_state.h"

namespace grinder {

namespace {

const ros::WallDuration kTimeout(3);

}  // namespace

const char* const kLinkLost =
    "the connection to the grinder is lost: no message for 3 s; the state of the machine is unknown";

bool inJob(const flute_grinder::GrinderState& state) { return isInJob(static_cast<MachineState>(state.state)); }

bool StateWatch::awaitNext() const {
  // The first two states may have been sent before the call.
  const std::uint64_t enough = state_.count() + 3;
  return await(kTimeout, [&] { return state_.count() >= enough; });
}

flute_grinder::GrinderState StateWatch::newest() const {
  const auto newest = state_.newest();
  return newest ? *newest : flute_grinder::GrinderState();
}

bool StateWatch::lost() const { return !ros::ok() || !state_.isFresh(kTimeout); }

}  // namespace grinder
