#pragma once

#include "flute_grinder/base/enum_table.h"

#include <cstdint>
#include <optional>
#include <string>

namespace grinder {

/// What the machine is doing.
enum class MachineState : std::uint8_t {
  kDisabled,          ///< power off; commands follow the positions
  kReady,             ///< power on, at rest
  kHoming,            ///< the drive is searching for the axes' reference
  kStarting,          ///< a job is waiting for spindle and coolant
  kRunning,           ///< a job is moving the axes
  kHolding,           ///< stopping on the path
  kHeld,              ///< at rest in the middle of a job
  kRetracting,        ///< lifting the wheel off the workpiece
  kRetracted,         ///< at rest in the middle of a job, with the wheel off the workpiece
  kResuming,          ///< returning to the point where the path was left
  kCanceling,         ///< stopping on the path and lifting the wheel, to end the job
  kFault,             ///< power off after a fault, until reset
  kLifting,           ///< lifting the wheel off the workpiece, without a job
  kJogging,           ///< an axis is moved by hand, without a job
  kJoggingRetracted,  ///< an axis is moved by hand in the middle of a job, with the wheel off the workpiece
};

/// A rough classification of the states for people.
enum class StateGroup : std::uint8_t {
  kOff,      ///< power off, and unknown states
  kReady,    ///< a job may begin
  kActive,   ///< the axes move, or are about to
  kPausing,  ///< the axes stop or rest during a job
  kFault,
};

struct StateRow : EnumRow<MachineState> {
  StateGroup group = StateGroup::kOff;
  bool moves = true;          ///< whether axes may move
  bool holds_job = false;     ///< whether a job is held
  const char* sentence = "";  ///< sentence for people
};

inline constexpr StateRow kMachineStates[]{
    {{MachineState::kDisabled, "disabled"}, StateGroup::kOff, false, false, "The power is off. Enable switches it on."},
    {{MachineState::kReady, "ready"},
     StateGroup::kReady,
     false,
     false,
     "The power is on, the axes rest. Plan a job, then start it."},
    {{MachineState::kHoming, "homing"}, StateGroup::kActive, true, false, "The drive is homing the axes."},
    {{MachineState::kStarting, "starting"},
     StateGroup::kActive,
     false,
     false,
     "The job waits for spindle and coolant."},
    {{MachineState::kRunning, "running"}, StateGroup::kActive, true, false, "The job moves the axes."},
    {{MachineState::kHolding, "holding"}, StateGroup::kPausing, true, true, "The axes are stopping on the path."},
    {{MachineState::kHeld, "held"}, StateGroup::kPausing, false, true, "The job is held, at rest. Resume continues."},
    {{MachineState::kRetracting, "retracting"},
     StateGroup::kPausing,
     true,
     true,
     "The wheel is being lifted off the work."},
    {{MachineState::kRetracted, "retracted"},
     StateGroup::kPausing,
     false,
     true,
     "The wheel is off the work. Resume continues the job."},
    {{MachineState::kResuming, "resuming"},
     StateGroup::kActive,
     true,
     false,
     "The wheel is returning to where it left the path."},
    {{MachineState::kCanceling, "canceling"},
     StateGroup::kPausing,
     true,
     false,
     "The axes stop on the path, the wheel is lifted, then the job ends."},
    {{MachineState::kFault, "fault"},
     StateGroup::kFault,
     false,
     false,
     "The power is off after a fault. Reset, then enable."},
    {{MachineState::kLifting, "lifting"},
     StateGroup::kActive,
     true,
     false,
     "The wheel is being lifted off the work, without a job."},
    {{MachineState::kJogging, "jogging"}, StateGroup::kActive, true, false, "An axis is being jogged."},
    {{MachineState::kJoggingRetracted, "jogging_retracted"},
     StateGroup::kActive,
     true,
     true,
     "An axis is being jogged; the job waits. Resume returns to the path."},
};
constexpr auto& rowsOf(MachineState) noexcept { return kMachineStates; }

/// Events that may change the state: requests from outside, in the order in which they are shown to people, and events
/// that the loop detects itself.
enum class MachineEvent : std::uint8_t {
  kEnable,
  kDisable,
  kHome,
  kReset,
  kStart,
  kHold,
  kRetract,
  kResume,
  kCancel,
  kLift,
  kJog,
  kSpindleOn,
  kSpindleOff,
  kCoolantOn,
  kCoolantOff,
  kDone,    ///< the state's task or wait is complete: reference found, spindle and coolant ready, end of the path
  kAtRest,  ///< the axes have come to rest
  kFault,
};

/// How an event reaches the state machine.
enum class EventKind : std::uint8_t {
  kSeen,     ///< detected by the loop itself
  kTrigger,  ///< a request without arguments
  kStop,     ///< a request that stops the axes
  kStart,    ///< a request that starts a job
  kJog,      ///< a request that moves an axis
  kSwitch,   ///< a request without arguments that switches spindle or coolant by hand and changes no state
};

/// An event with its name, which for a request is also its sub-command of `grind`; a name of two words is a command and
/// its sub-command. Exception: the sub-command of the start is `run`.
struct EventRow : EnumRow<MachineEvent> {
  EventKind kind = EventKind::kSeen;
  const char* service = nullptr;  ///< name of the service in the node's own namespace; null for none
  const char* help = "";          ///< effect of the request, for people
};

inline constexpr EventRow kMachineEvents[]{
    {{MachineEvent::kEnable, "enable"}, EventKind::kTrigger, "enable", "switch the power on; nothing moves"},
    {{MachineEvent::kDisable, "disable"},
     EventKind::kStop,
     "disable",
     "switch the power off; a job is first stopped on the path and the wheel lifted"},
    {{MachineEvent::kHome, "home"}, EventKind::kTrigger, "home", "reference the axes, which may move"},
    {{MachineEvent::kReset, "reset"}, EventKind::kTrigger, "reset_fault", "reset a fault; the power stays off"},
    {{MachineEvent::kStart, "start"}, EventKind::kStart, nullptr, "grind the planned job"},
    {{MachineEvent::kHold, "hold"}, EventKind::kStop, "hold", "stop on the path; the wheel keeps turning"},
    {{MachineEvent::kRetract, "retract"}, EventKind::kTrigger, "retract", "after hold, lift the wheel off the work"},
    {{MachineEvent::kResume, "resume"}, EventKind::kTrigger, "resume", "continue after hold or retract"},
    {{MachineEvent::kCancel, "cancel"}, EventKind::kStop, nullptr, "stop on the path, lift the wheel and end the job"},
    {{MachineEvent::kLift, "lift"}, EventKind::kTrigger, "lift", "lift the wheel off the work, without a job"},
    {{MachineEvent::kJog, "jog"}, EventKind::kJog, nullptr, "move an axis by hand"},
    {{MachineEvent::kSpindleOn, "spindle on"},
     EventKind::kSwitch,
     "spindle_on",
     "turn the wheel, without a job or after retract; until it or the power is switched off"},
    {{MachineEvent::kSpindleOff, "spindle off"},
     EventKind::kSwitch,
     "spindle_off",
     "stop the wheel, without a job or after retract"},
    {{MachineEvent::kCoolantOn, "coolant on"},
     EventKind::kSwitch,
     "coolant_on",
     "switch the coolant on, without a job or after retract; until it or the power is switched off"},
    {{MachineEvent::kCoolantOff, "coolant off"},
     EventKind::kSwitch,
     "coolant_off",
     "switch the coolant off, without a job or after retract"},
    {{MachineEvent::kDone, "done"}},
    {{MachineEvent::kAtRest, "at rest"}},
    {{MachineEvent::kFault, "fault"}},
};
constexpr auto& rowsOf(MachineEvent) noexcept { return kMachineEvents; }

/// Whether an event is a request from outside.
constexpr bool isRequest(MachineEvent event) noexcept { return rowOf(event).kind != EventKind::kSeen; }
/// Whether an event is a request that stops the axes.
constexpr bool isStop(MachineEvent event) noexcept { return rowOf(event).kind == EventKind::kStop; }
/// Whether an event is a request that switches spindle or coolant by hand.
constexpr bool isSwitch(MachineEvent event) noexcept { return rowOf(event).kind == EventKind::kSwitch; }
/// Whether an event is a request without arguments that does not stop the axes.
constexpr bool isTrigger(MachineEvent event) noexcept {
  return rowOf(event).kind == EventKind::kTrigger || isSwitch(event);
}
/// The node's service for a request; null if there is none.
constexpr const char* serviceOf(MachineEvent event) noexcept { return rowOf(event).service; }

/// The state after an event; std::nullopt if the state does not allow the event. Real-time safe.
std::optional<MachineState> after(MachineState state, MachineEvent event) noexcept;

/// Whether the drive has power and the loop checks the drive.
constexpr bool isPowered(MachineState state) noexcept {
  return state != MachineState::kDisabled && state != MachineState::kFault;
}

/// Whether a job is in progress, so that a cancel would end it.
bool isInJob(MachineState state) noexcept;

/// The requests that a state allows and that may change it, e.g. "disable, start (grind run)".
std::string allowedIn(MachineState state);

}  // namespace grinder
