#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace flute_grinder {

/// What the machine is doing.
enum class MachineState : std::uint8_t {
  kDisabled,    ///< power off; commands follow the positions
  kReady,       ///< power on, at rest
  kHoming,      ///< the drive looks for the axes' reference
  kStarting,    ///< a job waits for spindle and coolant
  kRunning,     ///< a job moves the axes
  kHolding,     ///< stopping on the path
  kHeld,        ///< at rest in the midst of a job
  kRetracting,  ///< lifting the wheel off the work
  kRetracted,   ///< at rest in the midst of a job, the wheel off the work
  kResuming,    ///< on the way back to the place where the path was left
  kCanceling,   ///< stopping on the path and lifting the wheel, to end the job
  kFault,       ///< power off after a fault, until reset
  kLifting,     ///< lifting the wheel off the work, without a job
};

/// What may change the state: requests from outside, and what the loop sees by itself.
enum class MachineEvent : std::uint8_t {
  kEnable,
  kDisable,
  kHome,
  kStart,
  kHold,
  kResume,
  kRetract,
  kLift,
  kCancel,
  kReset,
  kDone,    ///< what the state waited for has come: the reference, spindle and coolant, the path
  kAtRest,  ///< the axes have come to rest
  kFault,
};

const char* toString(MachineState state) noexcept;  ///< e.g. "ready"
const char* toString(MachineEvent event) noexcept;  ///< e.g. "enable"

/// Whether an event is a request from outside.
constexpr bool isRequest(MachineEvent event) noexcept { return event < MachineEvent::kDone; }

/// Whether an event is a request that stops the axes.
constexpr bool isStop(MachineEvent event) noexcept {
  return event == MachineEvent::kHold || event == MachineEvent::kCancel || event == MachineEvent::kDisable;
}

/// The state after an event, or nothing where the state does not allow it. Real-time safe.
std::optional<MachineState> after(MachineState state, MachineEvent event) noexcept;

/// Whether the drive has power and the loop checks it.
constexpr bool isPowered(MachineState state) noexcept {
  return state != MachineState::kDisabled && state != MachineState::kFault;
}

/// Whether a job is under way, which a cancel would end.
bool isInJob(MachineState state) noexcept;

/// Which requests a state allows, e.g. "disable, start".
std::string allowedIn(MachineState state);

}  // namespace flute_grinder
