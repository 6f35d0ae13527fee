#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/JobProgress.h"

#include <string>

namespace flute_grinder {

struct GrindJob;

/// Makes a goal start where a job was left, according to the journal.
/// @param progress progress reported by the grinder.
/// @param job the goal's job.
/// @return why this is not possible; empty if it is.
std::string continueFrom(const JobProgress& progress, const GrindJob& job, GrindGoal& goal);

/// How the last job ended, for display. @param progress of a job that no longer runs.
std::string endText(const JobProgress& progress);

}  // namespace flute_grinder
