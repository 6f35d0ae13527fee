#include "flute_grinder/machine/swivel.h"

#include "flute_grinder/base/quantity.h"

namespace grinder {

namespace {

constexpr int kAngleDigits = 10;  ///< digits with which the angle appears as in the job file

}  // namespace

Reason reasonOf(const Swivel& swivel, double asked) {
  const char* const known = std::isnan(swivel.angle) ? "" : swivel.measured ? "measured" : "confirmed";
  return {ReasonKind::kSwivel, 0, "process.setup_swivel", known, Unit::kRadian, swivel.angle, kSwivelTolerance, asked};
}

std::optional<Need> needOf(const Swivel& swivel, double asked) {
  if (swivel.isAt(asked)) return std::nullopt;
  const auto shown = [](double angle) { return text(Quantity{angle, Unit::kRadian}, kAngleDigits); };
  const bool known = std::isfinite(swivel.angle);
  Need need{NeedKind::kSwivel, text(reasonOf(swivel, asked)), {}, {}};
  need.figures.push_back(
      {"swivel", shown(asked), known ? shown(swivel.angle) : "not known", known ? shown(asked - swivel.angle) : ""});
  if (!swivel.measured) need.answers.push_back(NeedAnswer::kConfirmSwivel);
  return need;
}

}  // namespace grinder
