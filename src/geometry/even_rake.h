#pragma once

#include "flute_grinder/geometry/setup_solver.h"
#include "geometry/setup_trial.h"

namespace flute_grinder {

/// The set-up with the least largest error of the rake over the whole flute, near one that is exact at both ends of a
/// cone: between the ends the rake rises or falls, so the same error of the other sign is given to both. Found by
/// Newton's method; the core at X = 0 and what is kept stay.
/// @param trial of a right-hand cutter. @param request of the same, not of a cylinder. @param exact a solution of it.
/// @return the same point where no other within the request's swivel is better.
SetupPoint evenRake(const SetupTrial& trial, const SetupRequest& request, const SetupPoint& exact);

}  // namespace flute_grinder
