#pragma once

#include "flute_grinder/base/units.h"
#include "setup/flute_judge.h"

#include <functional>
#include <optional>

namespace grinder {

/// Maximum swivel at which the set-up of a flute or a relief is sought [rad].
constexpr double kWidestSwivel = 80 * units::kDegree;

/// The result of looking for a flute's set-up.
struct FoundFlute {
  /// The best set-up that is accepted, or else the one nearest to the asked tool; nothing if the wheel reaches the
  /// cutter in none.
  std::optional<JudgedFlute> best;
  bool accepted = false;
  std::optional<double> swivel_beyond;  ///< swivel of a set-up outside the machine's range that would do [rad]
};

/// Whether a set-up may be taken, by what only the caller knows.
using AcceptsFlute = std::function<bool(const JudgedFlute&)>;

/// Looks for the set-up that grinds a flute within its tolerances. Takes some tenths of a second, or some seconds if
/// there is none.
/// @param accepts called for the set-ups within the tolerances, the best first.
FoundFlute findFluteSetup(const FluteRequest& request, const AcceptsFlute& accepts);

/// What would make a tool possible that cannot be had: another wheel, or other cores. Nothing: 0.
struct FluteRemedy {
  double less_diameter = 0;               ///< how much smaller the wheel [m]
  double less_width = 0;                  ///< how much narrower [m]
  std::array<double, 2> core_diameter{};  ///< cores at the flute's ends [m]
};

/// @param nearest the set-up nearest to the asked tool.
FluteRemedy remedyFor(const FluteRequest& request, const SetupPoint& nearest);

}  // namespace grinder
