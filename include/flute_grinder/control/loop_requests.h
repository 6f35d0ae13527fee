#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/fault_text.h"
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
  kNotOffered,  ///< the drive cannot do it
  kEmergencyStop,
  kDriveFault,
  kDriveFaultStays,  ///< the drive was commanded to clear its fault, and still reports it
  kInterlock,
  kPreparing,    ///< the drive's prepare() has not returned
  kNotPrepared,  ///< the drive's prepare() has failed
  kNoPower,
  kPowerStays,  ///< the drive still reports the earlier power, so the new power could not be detected
  kMoved,
  kFeedback,
  kWithdrawn,       ///< an enable that was followed by a disable
  kInWork,          ///< the wheel is in the workpiece
  kMayBeInWork,     ///< whether the wheel is in a workpiece is unknown
  kNotInWork,       ///< the wheel is not in the workpiece
  kSwivel,          ///< the swivel is not at the angle of the job to start
  kSwivelMeasured,  ///< the drive measures the swivel, so it cannot be confirmed
  kSwivelInUse,     ///< a job in progress needs the swivel at another angle than the one to confirm
  kTooFar,          ///< a lift or a jog would exceed a limit of the axis
  kNoAxis,          ///< a jog of an axis that does not exist
  kJogSpeed,        ///< a jog at a speed that the axis does not allow
  kAtLimit,         ///< the axis stands at the end of the range of jogs
  kOutside,         ///< an axis stands outside its limits
  kJogging,         ///< another jog is in progress
  kJobOver,         ///< a jog in a job that was held at the very end of its path
  kStopped,         ///< a continuous jog that was stopped or refused, with the dead man's switch not released since
  kTimedOut,        ///< a continuous jog whose messages came too late, with the dead man's switch not released since
  kTouches,         ///< a jog to touch, while the probe touches already
  kWheelTurns,      ///< a jog of a probing cycle, while the spindle is commanded or at speed
  kProbing,         ///< switching the spindle on while the probe is being moved
  kStopCameFirst,   ///< a step of a series that was stopped before it
};

/// The loop's answer to a request: plain data, converted to text by other threads.
struct Answer {
  MachineEvent event = MachineEvent::kEnable;
  MachineState state = MachineState::kDisabled;  ///< state in which the request was refused
  Refusal refusal = Refusal::kNone;
  Interlock interlock = Interlock::kNone;  ///< the open interlock, for kInterlock
  int axis = kY;                           ///< axis that moves; for kOutside, the axis outside its limits
  double value = 0;                        ///< for kTooFar and kOutside: a position; for kJogSpeed: the speed
  double limit = 0;                        ///< allowed value
  Swivel swivel;                           ///< present swivel, for kSwivel and kSwivelMeasured
  double job_swivel = 0;                   ///< swivel of the job, for kSwivel and kSwivelInUse [rad]
  FaultText drive_text;  ///< the drive's text, for kNotPrepared, kDriveFault and kDriveFaultStays; may be empty

  RequestReply reply() const;
};

}  // namespace grinder
