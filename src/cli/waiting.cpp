#include "cli/waiting.h"

#include "flute_grinder/machine/machine_state.h"

namespace grinder {

namespace {

const ros::WallDuration kTimeout(3);
const ros::WallDuration kReading(0.5);  ///< time to read what has come while the whole computer stood still

}  // namespace

const char* const kLinkLost =
    "the connection to the grinder is lost: no message for 3 s; the state of the machine is unknown";

bool inJob(const flute_grinder::GrinderState& state) { return isInJob(static_cast<MachineState>(state.state)); }

bool awaitNext(const States& states) {
  // The first two states may have been sent before the call.
  const std::uint64_t enough = states.count() + 3;
  return await(kTimeout, [&] { return states.count() >= enough; });
}

bool isLost(const States& states) {
  return !ros::ok() || !await(kReading, [&] { return states.isFresh(kTimeout); });
}

}  // namespace grinder
