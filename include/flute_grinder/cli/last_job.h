#pragma once

#include "flute_grinder/JobProgress.h"

#include <string>

namespace flute_grinder {

/// What the journal says of the last job, in the operator's words and units: its file, its tool and how far it has
/// come.
/// @param progress of a job; its digest is not empty.
std::string lastJob(const JobProgress& progress);

}  // namespace flute_grinder
