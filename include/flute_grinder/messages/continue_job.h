#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/JobProgress.h"

#include <string>

namespace grinder {

struct GrindJob;

/// Makes a goal start where the journal says that a job was left.
/// @param progress progress reported by the grinder.
/// @param job the goal's job.
/// @return why this is not possible; empty if it is.
std::string continueFrom(const flute_grinder::JobProgress& progress, const GrindJob& job,
                         flute_grinder::GrindGoal& goal);

/// How the last job ended, for display.
/// @param progress progress of a job that no longer runs.
std::string endText(const flute_grinder::JobProgress& progress);

}  // namespace grinder
