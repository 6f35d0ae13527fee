#pragma once

#include "flute_grinder/base/fault_text.h"
#include "flute_grinder/motion/limit_check.h"

#include <cstdint>
#include <string>

namespace grinder {

/// The conditions for grinding; a value other than kNone names one that is not met.
enum class Interlock : std::uint8_t {
  kNone,
  kNotHomed,
  kSpindle,  ///< the spindle is not at speed
  kCoolant,  ///< the coolant is not flowing
  kProbe,    ///< the probe is in the wheel's path
  kSwivel,   ///< the swivel is not at the job's angle
  kJournal,  ///< the journal does not contain the job yet; only before a job begins
};

/// Each interlock with its name, shown while it is open.
inline constexpr EnumRow<Interlock> kInterlocks[]{
    {Interlock::kNone, ""},
    {Interlock::kNotHomed, "the axes are not homed"},
    {Interlock::kSpindle, "the spindle is not at speed"},
    {Interlock::kCoolant, "no coolant flows"},
    {Interlock::kProbe, "the measuring probe is in the way"},
    {Interlock::kSwivel, "the swivel is not at the job's angle"},
    {Interlock::kJournal, "the journal does not contain the job"},
};
constexpr auto& rowsOf(Interlock) noexcept { return kInterlocks; }

/// Why the loop stopped the machine.
enum class FaultKind : std::uint8_t {
  kNone,
  kEmergencyStop,
  kDriveFault,       ///< the drive reports a fault
  kPowerLost,        ///< the drive is no longer enabled
  kStaleFeedback,    ///< no fresh position feedback
  kInvalidFeedback,  ///< a position is not a number
  kFollowingError,
  kUnderrun,   ///< a drive that buffers commands had none left for the axes
  kLate,       ///< the loop was late, and the axes had no buffered commands to follow
  kSlow,       ///< the loop's cycles take much longer than the control period
  kLimit,      ///< a setpoint exceeds a limit of an axis
  kHoming,     ///< the drive did not find its reference
  kInterlock,  ///< a job could not begin; the machine stays ready
};

/// The category of a fault for a goal's client; each is a code of its result.
enum class FaultClass : std::uint8_t { kNone, kEmergencyStop, kHardware, kLinkLost, kTolerance, kLimit, kNotReady };

struct FaultRow {
  FaultKind value{};
  ReasonKind reason{};      ///< reason of the fault; for kLimit, the violation determines it
  Unit unit = Unit::kNone;  ///< unit of value and limit; kMetre is for positions, which are in rad for A
  FaultClass fault_class = FaultClass::kHardware;
};

inline constexpr FaultRow kFaultKinds[]{
    {FaultKind::kNone, ReasonKind::kNone, Unit::kNone, FaultClass::kNone},
    {FaultKind::kEmergencyStop, ReasonKind::kEmergencyStop, Unit::kNone, FaultClass::kEmergencyStop},
    {FaultKind::kDriveFault, ReasonKind::kDriveFault, Unit::kNone, FaultClass::kHardware},
    {FaultKind::kPowerLost, ReasonKind::kPowerLost, Unit::kNone, FaultClass::kHardware},
    {FaultKind::kStaleFeedback, ReasonKind::kStaleFeedback, Unit::kSecond, FaultClass::kLinkLost},
    {FaultKind::kInvalidFeedback, ReasonKind::kInvalidFeedback, Unit::kMetre, FaultClass::kHardware},
    {FaultKind::kFollowingError, ReasonKind::kFollowingError, Unit::kMetre, FaultClass::kTolerance},
    {FaultKind::kUnderrun, ReasonKind::kUnderrun, Unit::kNone, FaultClass::kHardware},
    {FaultKind::kLate, ReasonKind::kLate, Unit::kSecond, FaultClass::kHardware},
    {FaultKind::kSlow, ReasonKind::kSlow, Unit::kSecond, FaultClass::kHardware},
    {FaultKind::kLimit, ReasonKind::kNone, Unit::kNone, FaultClass::kLimit},
    {FaultKind::kHoming, ReasonKind::kHoming, Unit::kSecond, FaultClass::kHardware},
    {FaultKind::kInterlock, ReasonKind::kInterlock, Unit::kSecond, FaultClass::kNotReady},
};
constexpr auto& rowsOf(FaultKind) noexcept { return kFaultKinds; }

/// A fault with its values: plain data, converted to text outside the loop.
struct LoopFault {
  FaultKind kind = FaultKind::kNone;
  int axis = 0;
  double value = 0;                        ///< the value that exceeded its limit
  double limit = 0;                        ///< limit that the value exceeded
  std::uint64_t cycle = 0;                 ///< cycle of the last setpoint written, for kUnderrun
  LimitViolation violation;                ///< violation, for kLimit
  Interlock interlock = Interlock::kNone;  ///< open interlock, for kInterlock
  FaultText drive_text;                    ///< text of the drive, for kDriveFault; may be empty

  /// The fault as text in SI units, e.g. "axis_x following error 0.0012 m is beyond its limit 0.001 m". Not real-time
  /// safe.
  std::string text() const;
};

/// Converts a fault to a reason. Not real-time safe.
Reason reasonOf(const LoopFault& fault);

}  // namespace grinder
