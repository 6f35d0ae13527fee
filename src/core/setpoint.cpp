#include "flute_grinder/core/setpoint.h"

namespace flute_grinder {

const char* toString(MoveKind kind) noexcept {
  switch (kind) {
    case MoveKind::kLift: return "lift";
    case MoveKind::kIndex: return "index";
    case MoveKind::kPosition: return "position";
    case MoveKind::kApproach: return "approach";
    case MoveKind::kInfeed: return "infeed";
    case MoveKind::kStroke: return "stroke";
    case MoveKind::kRetract: return "retract";
    case MoveKind::kReturn: return "return";
  }
  return "unknown";
}

const char* toString(StepKind kind) noexcept {
  switch (kind) {
    case StepKind::kNone: return "none";
    case StepKind::kOdd: return "odd";
    case StepKind::kEven: return "even";
  }
  return "unknown";
}

}  // namespace flute_grinder
