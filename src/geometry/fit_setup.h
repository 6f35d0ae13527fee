#pragma once

#include "flute_grinder/geometry/setup_solver.h"
#include "geometry/setup_trial.h"

#include <optional>

namespace flute_grinder {

/// The set-up of a cone that gives all that is asked: the rake at both ends, the angle of the edge between them, and
/// the cores. By the published law of Z the rake rises or falls between the ends, so the same error of the other sign
/// is given to both: the set-up with the least largest error over the flute. Found by Newton's method.
/// @param trial of a right-hand cutter. @param request of the same, not of a cylinder.
/// @param start from which the way to what is asked begins.
/// @param cores whether the asked cores count; else the depth and taper of the start stay.
/// @return nothing if none is found from there.
std::optional<SetupPoint> fitSetup(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& start,
                                   bool cores);

}  // namespace flute_grinder
