#include "flute_grinder/messages/error_codes.h"

#include "flute_grinder/GrindResult.h"

namespace flute_grinder {

int errorCode(PlanFault fault) {
  switch (fault) {
    case PlanFault::kNone: return GrindResult::SUCCESSFUL;
    case PlanFault::kLimit: return GrindResult::LIMIT_VIOLATED;
    case PlanFault::kTolerance: return GrindResult::PATH_TOLERANCE_VIOLATED;
    case PlanFault::kInvalidJob:
    case PlanFault::kTool:
    case PlanFault::kCollision:
    case PlanFault::kTooLong: return GrindResult::INVALID_GOAL;
    case PlanFault::kGivenUp: return GrindResult::CANCELED;
  }
  return GrindResult::INVALID_GOAL;
}

int errorCode(FaultKind fault) {
  switch (rowOf(fault).fault_class) {
    case FaultClass::kNone: return GrindResult::SUCCESSFUL;
    case FaultClass::kEmergencyStop: return GrindResult::EMERGENCY_STOP;
    case FaultClass::kHardware: return GrindResult::HARDWARE_FAULT;
    case FaultClass::kLinkLost: return GrindResult::LINK_LOST;
    case FaultClass::kTolerance: return GrindResult::PATH_TOLERANCE_VIOLATED;
    case FaultClass::kLimit: return GrindResult::LIMIT_VIOLATED;
    case FaultClass::kNotReady: return GrindResult::NOT_READY;
  }
  return GrindResult::HARDWARE_FAULT;
}

}  // namespace flute_grinder
