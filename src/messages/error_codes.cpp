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
  switch (fault) {
    case FaultKind::kNone: return GrindResult::SUCCESSFUL;
    case FaultKind::kEmergencyStop: return GrindResult::EMERGENCY_STOP;
    case FaultKind::kStaleFeedback: return GrindResult::LINK_LOST;
    case FaultKind::kFollowingError: return GrindResult::PATH_TOLERANCE_VIOLATED;
    case FaultKind::kLimit: return GrindResult::LIMIT_VIOLATED;
    case FaultKind::kDriveFault:
    case FaultKind::kPowerLost:
    case FaultKind::kUnderrun:
    case FaultKind::kLate:
    case FaultKind::kHoming:
    case FaultKind::kInvalidFeedback: return GrindResult::HARDWARE_FAULT;
    case FaultKind::kInterlock: return GrindResult::NOT_READY;
  }
  return GrindResult::HARDWARE_FAULT;
}

}  // namespace flute_grinder
