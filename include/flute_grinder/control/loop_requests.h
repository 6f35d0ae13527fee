#pragma once

#include "flute_grinder/core/loop_fault.h"
#include "flute_grinder/core/machine_state.h"

#include <cstdint>
#include <string>

namespace flute_grinder {

/// Whether a request was executed, and if not, why.
struct RequestReply {
  bool accepted = false;
  std::string text;      ///< why it was not executed
  bool answered = true;  ///< false if the loop did not answer in time; it may still execute the request
};

/// Why a request was refused.
enum class Refusal : std::uint8_t {
  kNone,
  kState,
  kEmergencyStop,
  kDriveFault,
  kInterlock,
  kNoPower,
  kMoved,
  kFeedback,
  kWithdrawn,   ///< an enable that was followed by a disable
  kInWork,      ///< the wheel is in the workpiece
  kNotInWork,   ///< the wheel is not in the workpiece
  kLiftTooFar,  ///< the lift would exceed the limit of Y
};

/// The loop's answer to a request: plain data, converted to text by other threads.
struct Answer {
  MachineEvent event = MachineEvent::kEnable;
  MachineState state = MachineState::kDisabled;  ///< the state in which it was refused
  Refusal refusal = Refusal::kNone;
  Interlock interlock = Interlock::kNone;  ///< for kInterlock
  double value = 0;                        ///< for kLiftTooFar: target Y of the lift [m]
  double limit = 0;                        ///< for kLiftTooFar: limit of Y [m]

  RequestReply reply() const;
};

}  // namespace flute_grinder
