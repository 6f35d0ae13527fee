#pragma once

#include "flute_grinder/core/limit_check.h"

#include <cstdint>
#include <string>

namespace flute_grinder {

/// What must be so for the wheel to be at the work.
enum class Interlock : std::uint8_t {
  kNone,
  kNotHomed,
  kSpindle,  ///< not at speed
  kCoolant,  ///< does not flow
  kProbe,    ///< in the wheel's way
};

/// What is wrong, e.g. "the spindle is not at speed"; empty for kNone.
const char* toString(Interlock interlock) noexcept;

/// Why the loop stopped the machine.
enum class FaultKind : std::uint8_t {
  kNone,
  kEmergencyStop,
  kDriveFault,       ///< the drive reports one
  kPowerLost,        ///< the drive is no longer enabled
  kStaleFeedback,    ///< no fresh positions
  kInvalidFeedback,  ///< a position that is not a number
  kFollowingError,
  kUnderrun,   ///< the axes found no command, though they move by a buffer that the loop fills
  kLate,       ///< the loop came too late for axes that had nothing to follow meanwhile
  kLimit,      ///< a setpoint that an axis may not follow
  kHoming,     ///< the drive did not find its reference
  kInterlock,  ///< a job could not begin; the machine stays ready
};

/// A fault with its values; plain data, put in words outside of the loop.
struct LoopFault {
  FaultKind kind = FaultKind::kNone;
  int axis = 0;
  double value = 0;                        ///< of what went too far
  double limit = 0;                        ///< how far it may go
  std::uint64_t cycle = 0;                 ///< of the last setpoint written, of kUnderrun
  LimitViolation violation;                ///< of kLimit
  Interlock interlock = Interlock::kNone;  ///< of kInterlock

  /// In words and SI, e.g. "axis_x following error 0.0012 m is beyond its limit 0.001 m". Not real-time safe.
  std::string text() const;
};

/// A fault as a reason. Not real-time safe.
core::Reason reasonOf(const LoopFault& fault);

}  // namespace flute_grinder
