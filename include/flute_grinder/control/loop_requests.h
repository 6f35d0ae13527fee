#pragma once

#include "flute_grinder/core/loop_fault.h"
#include "flute_grinder/core/machine_state.h"

#include <cstdint>
#include <string>

namespace flute_grinder {

/// Whether a request was executed, and if not, why.
struct RequestReply {
  bool accepted = false;
  std::string text;      ///< why not
  bool answered = true;  ///< false if the loop timed out; it may still act on the request
};

/// Why a request is refused.
enum class Refusal : std::uint8_t {
  kNone,
  kState,
  kEmergencyStop,
  kDriveFault,
  kInterlock,
  kNoPower,
  kMoved,
  kFeedback,
  kWithdrawn,   ///< an enable that a disable overtook
  kInWork,      ///< the wheel
  kNotInWork,   ///< the wheel
  kLiftTooFar,  ///< for the axis
};

/// The loop's answer to a request: plain data, turned into text by other threads.
struct Answer {
  MachineEvent event = MachineEvent::kEnable;
  MachineState state = MachineState::kDisabled;  ///< in which it was refused
  Refusal refusal = Refusal::kNone;
  Interlock interlock = Interlock::kNone;  ///< of kInterlock
  double value = 0;                        ///< of kLiftTooFar: Y that the lift would lead to [m]
  double limit = 0;                        ///< of kLiftTooFar: the axis' limit [m]

  RequestReply reply() const;
};

}  // namespace flute_grinder
