#pragma once

#include "flute_grinder/geometry/setup_solver.h"
#include "geometry/setup_trial.h"

#include <optional>

namespace grinder {

/// The tool that a set-up grinds, and what is wrong with it.
struct Judged {
  SetupPoint point;
  SolvedSetup solved;
  double formed_by_face = 1;  ///< of the depth of the rake face, least over the flute
  double error = 0;           ///< the largest over the flute, by its tolerance
  bool is_facet = false;      ///< the rake is that of a facet at the edge, with another angle behind it
  double chord_off = 0;       ///< maximum difference of the chordal rake from the asked rake [rad]
  double away = 0;            ///< the swivel from the spiral angle [rad], and the depth, by the radius
  bool cut_short = false;     ///< near a cone's apex, where no overtravel makes the flute complete, or a very long one
  std::optional<SetupProblem> problem;
};

/// The least angle from one tooth to the next. @param angles ascending within one turn [rad].
double minPitch(const std::vector<double>& angles);

/// @param trial of a right-hand cutter. @param request of the same.
Judged judge(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& point);

/// The better of two: with the lesser problem, then with a complete flute, nearer to what is asked, with the steadier
/// rake, the better chord, with more of the rake face formed by the wheel's face, then shallower and with the swivel
/// nearer to the spiral angle. Differences of the rake that cannot be measured do not count.
bool isBetter(const Judged& a, const Judged& b);

}  // namespace grinder
