#include "flute_grinder/machine/swivel.h"

namespace grinder {

Reason reasonOf(const Swivel& swivel, double asked) {
  const char* const known = std::isnan(swivel.angle) ? "" : swivel.measured ? "measured" : "confirmed";
  return {ReasonKind::kSwivel, 0, "process.setup_swivel", known, Unit::kRadian, swivel.angle, kSwivelTolerance, asked};
}

}  // namespace grinder
