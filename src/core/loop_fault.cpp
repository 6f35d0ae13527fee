#include "flute_grinder/core/loop_fault.h"

#include <sstream>

namespace flute_grinder {

const char* toString(Interlock interlock) noexcept {
  switch (interlock) {
    case Interlock::kNone: return "";
    case Interlock::kNotHomed: return "the axes are not homed";
    case Interlock::kSpindle: return "the spindle is not at speed";
    case Interlock::kCoolant: return "no coolant flows";
    case Interlock::kProbe: return "the measuring probe is in the way";
  }
  return "unknown";
}

std::string LoopFault::text() const {
  const std::string unit = std::string(" ") + axisUnit(axis);
  const char* joint = kJointNames[static_cast<std::size_t>(axis)];
  std::ostringstream text;
  switch (kind) {
    case FaultKind::kNone: break;
    case FaultKind::kEmergencyStop: text << "emergency stop"; break;
    case FaultKind::kDriveFault: text << "the drive reports a fault"; break;
    case FaultKind::kPowerLost: text << "the drive has switched its power off"; break;
    case FaultKind::kStaleFeedback:
      text << "no fresh positions from the drive for " << value << " s, allowed " << limit << " s";
      break;
    case FaultKind::kInvalidFeedback: text << joint << " position from the drive is " << value; break;
    case FaultKind::kFollowingError:
      text << joint << " following error " << value << unit << " is beyond its limit " << limit << unit;
      break;
    case FaultKind::kUnderrun:
      text << "the axes found no setpoint in " << value << " servo cycles, after setpoint " << cycle;
      break;
    case FaultKind::kLate:
      text << "the control loop came " << value << " s after the cycle before, allowed " << limit << " s";
      break;
    case FaultKind::kLimit: text << violation.text(); break;
    case FaultKind::kHoming:
      text << "the drive has not found its reference after " << value << " s, allowed " << limit << " s";
      break;
    case FaultKind::kInterlock:
      text << toString(interlock) << ' ' << value << " s after the job was started, allowed " << limit << " s";
      break;
  }
  return text.str();
}

}  // namespace flute_grinder
