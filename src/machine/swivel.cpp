#include "flute_grinder/machine/swivel.h"

namespace flute_grinder {

core::Reason reasonOf(const Swivel& swivel, double asked) {
  core::Reason reason;
  reason.kind = core::ReasonKind::kSwivel;
  reason.field = "process.setup_swivel";
  if (!std::isnan(swivel.angle)) reason.detail = swivel.measured ? "measured" : "confirmed";
  reason.unit = Unit::kRadian;
  reason.value = swivel.angle;
  reason.low = kSwivelTolerance;
  reason.limit = asked;
  return reason;
}

}  // namespace flute_grinder
