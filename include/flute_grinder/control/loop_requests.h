#pragma once

#include "flute_grinder/job/axes.h"
#include "flute_grinder/job/fault_text.h"
#include "flute_grinder/machine/loop_fault.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/machine/swivel.h"

#include <cstdint>
#include <string>

namespace grinder {

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
  kNotOffered,  ///< by the drive
  kEmergencyStop,
  kDriveFault,
  kDriveFaultStays,  ///< the drive was commanded to clear its fault, and still reports it
  kInterlock,
  kPreparing,    ///< the drive's prepare() has not returned
  kNotPrepared,  ///< the drive's prepare() has failed
  kNoPower,
  kPowerStays,  ///< that of before, so that the new could not be told from it
  kMoved,
  kFeedback,
  kWithdrawn,       ///< an enable that was followed by a disable
  kInWork,          ///< the wheel is in the workpiece
  kMayBeInWork,     ///< nobody knows whether the wheel is in a workpiece
  kNotInWork,       ///< the wheel is not in the workpiece
  kSwivel,          ///< not at the angle of the job that was to start
  kSwivelMeasured,  ///< by the drive, so that it cannot be confirmed
  kSwivelInUse,     ///< by a job in progress, at another angle than the one to confirm
  kTooFar,          ///< a lift or a jog would exceed a limit of the axis
  kNoAxis,          ///< a jog of an axis that does not exist
  kJogSpeed,        ///< a jog at a speed that the axis does not allow
  kAtLimit,         ///< the axis stands at the end of the range of jogs
  kOutside,         ///< an axis stands outside its limits
  kJogging,         ///< another jog is not over
  kJobOver,         ///< a jog in a job that was held at the very end of its path
  kStopped,         ///< a continuous jog that was stopped or refused, and not released since
  kTimedOut,        ///< a continuous jog whose messages had failed to come in time, and not released since
  kTouches,         ///< a jog to touch, while the probe touches already
  kWheelTurns,      ///< a jog of a probing cycle, while the spindle is commanded or at speed
  kProbing,         ///< the spindle, while the probe is being moved
  kStopCameFirst,   ///< a jog of a sequence that was stopped before it
};

/// The loop's answer to a request: plain data, converted to text by other threads.
struct Answer {
  MachineEvent event = MachineEvent::kEnable;
  MachineState state = MachineState::kDisabled;  ///< the state in which it was refused
  Refusal refusal = Refusal::kNone;
  Interlock interlock = Interlock::kNone;  ///< for kInterlock
  int axis = kY;                           ///< that moves; for kOutside, the one outside
  double value = 0;                        ///< for kTooFar and kOutside: a position; for kJogSpeed: the speed
  double limit = 0;                        ///< what is allowed
  Swivel swivel;                           ///< for kSwivel and kSwivelMeasured
  double job_swivel = 0;                   ///< for kSwivel and kSwivelInUse [rad]
  FaultText drive_text;                    ///< for kNotPrepared, kDriveFault and kDriveFaultStays; may be empty

  RequestReply reply() const;
};

}  // namespace grinder
