#pragma once

#include "flute_grinder/geometry/job_setup.h"

#include <string>

namespace flute_grinder {

/// The height of a face of the wheel above the cutter's axis at Z = 0, where it is deepest in the cutter [m].
double upperFaceHeight(const GrindJob& job);
double lowerFaceHeight(const GrindJob& job);

/// The set-up sheet for the operator, in mm and deg: what to set, what to touch and what the axes then read, what comes
/// out, and what limits it.
/// @param swivel that the machine allows [rad].
std::string setupSheet(const JobSetup& setup, const Range& swivel);

}  // namespace flute_grinder
