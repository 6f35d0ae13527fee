#pragma once

#include "flute_grinder/setup/job_setup.h"

#include <optional>
#include <string>

namespace grinder {

/// Heights of the wheel's faces above the cutter's axis at Z = 0, where the wheel is deepest in the cutter [m].
double upperFaceHeight(const GrindJob& job);
double lowerFaceHeight(const GrindJob& job);

/// The set-up sheet for the operator, in mm and deg: settings, touch points with the axis readings, the resulting tool,
/// and its limits.
/// @param swivel range that the machine allows [rad].
/// @param above_swivel see wheelAboveSwivel(); if unknown, the sheet states its effect [m].
std::string setupSheet(const JobSetup& setup, const Range& swivel, const std::optional<double>& above_swivel);

/// The changes of a set-up, a line for each figure in the job file's units: before, solved, and the difference.
/// @param before operation with its present set-up; nothing if it has none.
std::string changesText(const std::optional<GrindProcess>& before, const GrindJob& solved);

/// Why a plan would refuse the tool, a line for each reason; empty if it would not. A set-up with a reason must not be
/// written.
std::string planRefusal(const JobSetup& setup);

}  // namespace grinder
