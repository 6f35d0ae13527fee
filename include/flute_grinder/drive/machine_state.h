#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace flute_grinder {

/// What the machine is doing.
enum class MachineState : std::uint8_t {
  kDisabled,   ///< power off; commands follow the positions
  kReady,      ///< power on, at rest
  kRunning,    ///< a job moves the axes
  kCanceling,  ///< stopping on the path, to end the job
  kFault,      ///< power off after a fault, until reset
};

/// What may change the state: requests from outside, and what the loop sees by itself.
enum class MachineEvent : std::uint8_t {
  kEnable,
  kDisable,
  kStart,
  kCancel,
  kReset,
  kFinished,  ///< the job came to rest at its end, or after a cancel
  kFault,
};

const char* toString(MachineState state) noexcept;  ///< e.g. "ready"
const char* toString(MachineEvent event) noexcept;  ///< e.g. "enable"

/// The state after an event, or nothing where the state does not allow it. Real-time safe.
std::optional<MachineState> after(MachineState state, MachineEvent event) noexcept;

/// Which requests a state allows, e.g. "start, disable".
std::string allowedIn(MachineState state);

}  // namespace flute_grinder
