#include "flute_grinder/machine/swivel.h"

namespace grinder {

Reason reasonOf(const Swivel& swivel, double asked) {
  Reason reason;
  reason.kind = ReasonKind::kSwivel;
  reason.field = "process.setup_swivel";
  if (!std::isnan(swivel.angle)) reason.detail = swivel.measured ? "measured" : "confirmed";
  reason.unit = Unit::kRadian;
  reason.value = swivel.angle;
  reason.low = kSwivelTolerance;
  reason.limit = asked;
  return reason;
}

}  // namespace grinder
