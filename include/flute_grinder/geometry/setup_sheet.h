#pragma once

#include "flute_grinder/geometry/job_setup.h"

#include <optional>
#include <string>

namespace grinder {

/// The height of a face of the wheel above the cutter's axis at Z = 0, where it is deepest in the cutter [m].
double upperFaceHeight(const GrindJob& job);
double lowerFaceHeight(const GrindJob& job);

/// The set-up sheet for the operator, in mm and deg: what to set, what to touch and what the axes then read, what comes
/// out, and what limits it.
/// @param swivel that the machine allows [rad].
/// @param above_swivel as of wheelAboveSwivel() [m]; if it is not known, the sheet says what it changes.
std::string setupSheet(const JobSetup& setup, const Range& swivel, const std::optional<double>& above_swivel);

/// Why a plan would refuse the tool, a line for each reason; empty if it would not. A set-up with one is not to be
/// written.
std::string planRefusal(const JobSetup& setup);

}  // namespace grinder
