#pragma once

#include "flute_grinder/motion/limit_check.h"

#include <cstdint>
#include <string>

namespace flute_grinder {

/// The conditions for grinding. The value names one that is not met.
enum class Interlock : std::uint8_t {
  kNone,
  kNotHomed,
  kSpindle,  ///< not at speed
  kCoolant,  ///< not flowing
  kProbe,    ///< in the wheel's path
  kSwivel,   ///< not at the job's angle
  kJournal,  ///< does not contain the job yet; only before a job begins
};

/// Describes the open interlock, e.g. "the spindle is not at speed"; empty for kNone.
const char* toString(Interlock interlock) noexcept;

/// Why the loop stopped the machine.
enum class FaultKind : std::uint8_t {
  kNone,
  kEmergencyStop,
  kDriveFault,       ///< reported by the drive
  kPowerLost,        ///< the drive is no longer enabled
  kStaleFeedback,    ///< no fresh position feedback
  kInvalidFeedback,  ///< a position is not a number
  kFollowingError,
  kUnderrun,   ///< a drive that buffers commands had none left for the axes
  kLate,       ///< the loop was late, and the axes had no buffered commands to follow
  kLimit,      ///< a setpoint exceeds a limit of an axis
  kHoming,     ///< the drive did not find its reference
  kInterlock,  ///< a job could not begin; the machine stays ready
};

/// A fault with its values: plain data, converted to text outside the loop.
struct LoopFault {
  FaultKind kind = FaultKind::kNone;
  int axis = 0;
  double value = 0;                        ///< the value that exceeded its limit
  double limit = 0;                        ///< the limit it exceeded
  std::uint64_t cycle = 0;                 ///< of the last setpoint written, for kUnderrun
  LimitViolation violation;                ///< for kLimit
  Interlock interlock = Interlock::kNone;  ///< for kInterlock

  /// The fault as text in SI units, e.g. "axis_x following error 0.0012 m is beyond its limit 0.001 m". Not real-time
  /// safe.
  std::string text() const;
};

/// Converts a fault to a reason. Not real-time safe.
core::Reason reasonOf(const LoopFault& fault);

}  // namespace flute_grinder
