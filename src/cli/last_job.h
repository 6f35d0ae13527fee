#pragma once

#include "flute_grinder/JobProgress.h"

#include <string>

namespace grinder {

/// The last job in the journal as text for the operator: its file, tool and progress.
/// @param progress progress of a job, with a digest that is not empty.
std::string lastJob(const flute_grinder::JobProgress& progress);

}  // namespace grinder
