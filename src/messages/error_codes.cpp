#include "flute_grinder/messages/error_codes.h"

#include "flute_grinder/GrindResult.h"

namespace grinder {

int errorCode(PlanFault fault) {
  switch (fault) {
    case PlanFault::kNone: return flute_grinder::GrindResult::SUCCESSFUL;
    case PlanFault::kLimit: return flute_grinder::GrindResult::LIMIT_VIOLATED;
    case PlanFault::kTolerance: return flute_grinder::GrindResult::PATH_TOLERANCE_VIOLATED;
    case PlanFault::kInvalidJob:
    case PlanFault::kTool:
    case PlanFault::kCollision:
    case PlanFault::kTooLong: return flute_grinder::GrindResult::INVALID_GOAL;
    case PlanFault::kGivenUp: return flute_grinder::GrindResult::CANCELED;
  }
  return flute_grinder::GrindResult::INVALID_GOAL;
}

int errorCode(FaultKind fault) {
  switch (rowOf(fault).fault_class) {
    case FaultClass::kNone: return flute_grinder::GrindResult::SUCCESSFUL;
    case FaultClass::kEmergencyStop: return flute_grinder::GrindResult::EMERGENCY_STOP;
    case FaultClass::kHardware: return flute_grinder::GrindResult::HARDWARE_FAULT;
    case FaultClass::kLinkLost: return flute_grinder::GrindResult::LINK_LOST;
    case FaultClass::kTolerance: return flute_grinder::GrindResult::PATH_TOLERANCE_VIOLATED;
    case FaultClass::kLimit: return flute_grinder::GrindResult::LIMIT_VIOLATED;
    case FaultClass::kNotReady: return flute_grinder::GrindResult::NOT_READY;
  }
  return flute_grinder::GrindResult::HARDWARE_FAULT;
}

}  // namespace grinder
