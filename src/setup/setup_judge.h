#pragma once

#include "flute_grinder/setup/setup_solver.h"
#include "setup/setup_trial.h"

#include <optional>

namespace grinder {

/// The tool of a set-up, and its faults.
struct Judged {
  SetupPoint point;
  SolvedSetup solved;
  double formed_by_face = 1;  ///< minimum over the flute, as a fraction of the rake face's depth
  double error = 0;           ///< maximum over the flute, per tolerance
  bool is_facet = false;      ///< whether a facet at the edge has the rake, with another angle behind it
  double chord_off = 0;       ///< maximum difference of the chordal rake from the asked rake [rad]
  double away = 0;            ///< angle between swivel and spiral angle [rad], plus depth per radius
  bool cut_short = false;     ///< near a cone's apex: no overtravel makes the flute complete, or only a very long one
  std::optional<SetupProblem> problem;
};

/// The minimum angle from one tooth to the next.
/// @param angles ascending within one turn [rad].
double minPitch(const std::vector<double>& angles);

/// @param trial trial of a right-hand cutter.
/// @param request request for the same cutter.
Judged judge(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point);

/// Whether one set-up is better than another: with the lesser problem, then with a complete flute, nearer to the asked
/// values, with the steadier rake, the better chord, more of the rake face formed by the wheel's face, then shallower
/// and with the swivel nearer to the spiral angle. Differences of the rake that cannot be measured do not count.
bool isBetter(const Judged& a, const Judged& b);

}  // namespace grinder
