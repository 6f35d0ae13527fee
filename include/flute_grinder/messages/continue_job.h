#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/JobProgress.h"
#include "flute_grinder/core/grind_job.h"

#include <string>

namespace flute_grinder {

/// Has a goal begin where the journal says that the job was left.
/// @param progress as the grinder tells it.
/// @param job the goal's job.
/// @return why it cannot be; empty if it can.
std::string continueFrom(const JobProgress& progress, const GrindJob& job, GrindGoal& goal);

}  // namespace flute_grinder
