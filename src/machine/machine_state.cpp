#include "flute_grinder/machine/machine_state.h"

namespace grinder {

namespace {

struct Transition {
  MachineState from;
  MachineEvent event;
  MachineState to;
};

using S = MachineState;
using E = MachineEvent;

constexpr Transition kTransitions[]{
    {S::kDisabled, E::kEnable, S::kReady},
    {S::kDisabled, E::kDisable, S::kDisabled},
    {S::kDisabled, E::kReset, S::kDisabled},  // clears a fault that the drive still has, or has had since

    {S::kReady, E::kEnable, S::kReady},
    {S::kReady, E::kDisable, S::kDisabled},
    {S::kReady, E::kHome, S::kHoming},
    {S::kReady, E::kStart, S::kStarting},
    {S::kReady, E::kLift, S::kLifting},
    {S::kReady, E::kJog, S::kJogging},
    {S::kReady, E::kFault, S::kFault},

    // The drive controls homing itself; only switching its power off stops it.
    {S::kHoming, E::kDisable, S::kDisabled},
    {S::kHoming, E::kHold, S::kDisabled},
    {S::kHoming, E::kCancel, S::kDisabled},
    {S::kHoming, E::kDone, S::kReady},
    {S::kHoming, E::kFault, S::kFault},

    {S::kStarting, E::kDisable, S::kCanceling},
    {S::kStarting, E::kHold, S::kStarting},  // the job then starts in hold, before anything moves
    {S::kStarting, E::kResume, S::kStarting},
    {S::kStarting, E::kCancel, S::kCanceling},
    {S::kStarting, E::kDone, S::kRunning},
    {S::kStarting, E::kAtRest, S::kReady},  // spindle and coolant did not become ready
    {S::kStarting, E::kFault, S::kFault},

    {S::kRunning, E::kDisable, S::kCanceling},
    {S::kRunning, E::kHold, S::kHolding},
    {S::kRunning, E::kCancel, S::kCanceling},
    {S::kRunning, E::kAtRest, S::kReady},
    {S::kRunning, E::kFault, S::kFault},

    {S::kHolding, E::kDisable, S::kCanceling},
    {S::kHolding, E::kHold, S::kHolding},
    {S::kHolding, E::kResume, S::kResuming},
    {S::kHolding, E::kCancel, S::kCanceling},
    {S::kHolding, E::kAtRest, S::kHeld},
    {S::kHolding, E::kFault, S::kFault},

    {S::kHeld, E::kDisable, S::kCanceling},
    {S::kHeld, E::kHold, S::kHeld},
    {S::kHeld, E::kResume, S::kResuming},
    {S::kHeld, E::kRetract, S::kRetracting},
    {S::kHeld, E::kCancel, S::kCanceling},
    {S::kHeld, E::kFault, S::kFault},

    {S::kRetracting, E::kDisable, S::kCanceling},
    {S::kRetracting, E::kHold, S::kHolding},
    {S::kRetracting, E::kCancel, S::kCanceling},
    {S::kRetracting, E::kAtRest, S::kRetracted},
    {S::kRetracting, E::kFault, S::kFault},

    {S::kRetracted, E::kDisable, S::kCanceling},
    {S::kRetracted, E::kResume, S::kResuming},
    {S::kRetracted, E::kCancel, S::kCanceling},
    {S::kRetracted, E::kJog, S::kJoggingRetracted},
    {S::kRetracted, E::kFault, S::kFault},

    {S::kResuming, E::kDisable, S::kCanceling},
    {S::kResuming, E::kHold, S::kHolding},
    {S::kResuming, E::kCancel, S::kCanceling},
    {S::kResuming, E::kDone, S::kRunning},
    {S::kResuming, E::kFault, S::kFault},

    {S::kCanceling, E::kDisable, S::kCanceling},
    {S::kCanceling, E::kHold, S::kCanceling},  // stops lifting the wheel
    {S::kCanceling, E::kCancel, S::kCanceling},
    {S::kCanceling, E::kAtRest, S::kReady},
    {S::kCanceling, E::kFault, S::kFault},

    {S::kFault, E::kDisable, S::kFault},  // the power is already off
    {S::kFault, E::kReset, S::kDisabled},

    // Each of these stops the lift.
    {S::kLifting, E::kDisable, S::kLifting},
    {S::kLifting, E::kHold, S::kLifting},
    {S::kLifting, E::kCancel, S::kLifting},
    {S::kLifting, E::kAtRest, S::kReady},
    {S::kLifting, E::kFault, S::kFault},

    // Each of the stops ends the jog; a continuous jog is requested again and again.
    {S::kJogging, E::kDisable, S::kJogging},
    {S::kJogging, E::kHold, S::kJogging},
    {S::kJogging, E::kCancel, S::kJogging},
    {S::kJogging, E::kJog, S::kJogging},
    {S::kJogging, E::kAtRest, S::kReady},
    {S::kJogging, E::kFault, S::kFault},

    {S::kJoggingRetracted, E::kDisable, S::kCanceling},
    {S::kJoggingRetracted, E::kHold, S::kJoggingRetracted},
    {S::kJoggingRetracted, E::kCancel, S::kCanceling},
    {S::kJoggingRetracted, E::kJog, S::kJoggingRetracted},
    {S::kJoggingRetracted, E::kAtRest, S::kRetracted},
    {S::kJoggingRetracted, E::kFault, S::kFault},

    // Spindle and coolant by hand: at rest or while an axis is jogged, in a job only with the wheel off the workpiece;
    // switching off also in every other state without a job.
    {S::kReady, E::kSpindleOn, S::kReady},
    {S::kReady, E::kSpindleOff, S::kReady},
    {S::kReady, E::kCoolantOn, S::kReady},
    {S::kReady, E::kCoolantOff, S::kReady},
    {S::kJogging, E::kSpindleOn, S::kJogging},
    {S::kJogging, E::kSpindleOff, S::kJogging},
    {S::kJogging, E::kCoolantOn, S::kJogging},
    {S::kJogging, E::kCoolantOff, S::kJogging},
    {S::kRetracted, E::kSpindleOn, S::kRetracted},
    {S::kRetracted, E::kSpindleOff, S::kRetracted},
    {S::kRetracted, E::kCoolantOn, S::kRetracted},
    {S::kRetracted, E::kCoolantOff, S::kRetracted},
    {S::kJoggingRetracted, E::kSpindleOn, S::kJoggingRetracted},
    {S::kJoggingRetracted, E::kSpindleOff, S::kJoggingRetracted},
    {S::kJoggingRetracted, E::kCoolantOn, S::kJoggingRetracted},
    {S::kJoggingRetracted, E::kCoolantOff, S::kJoggingRetracted},
    {S::kDisabled, E::kSpindleOff, S::kDisabled},
    {S::kDisabled, E::kCoolantOff, S::kDisabled},
    {S::kHoming, E::kSpindleOff, S::kHoming},
    {S::kHoming, E::kCoolantOff, S::kHoming},
    {S::kFault, E::kSpindleOff, S::kFault},
    {S::kFault, E::kCoolantOff, S::kFault},
    {S::kLifting, E::kSpindleOff, S::kLifting},
    {S::kLifting, E::kCoolantOff, S::kLifting},
};

}  // namespace

std::optional<MachineState> after(MachineState state, MachineEvent event) noexcept {
  for (const Transition& t : kTransitions) {
    if (t.from == state && t.event == event) return t.to;
  }
  return std::nullopt;
}

bool isInJob(MachineState state) noexcept { return after(state, E::kCancel) == S::kCanceling; }

std::string allowedIn(MachineState state) {
  std::string text;
  for (const Transition& t : kTransitions) {
    if (t.from != state || !isRequest(t.event) || isSwitch(t.event)) continue;
    text += (text.empty() ? "" : ", ") + std::string(toString(t.event));
    if (t.event == E::kStart) text += " (grind run)";  // all other events have commands with their names
  }
  return text;
}

}  // namespace grinder
