#pragma once

#include "flute_grinder/GrindGoal.h"

namespace flute_grinder {

/// As the jobs of jobs.h.
GrindGoal paperGoal();
GrindGoal wholeToolGoal();

}  // namespace flute_grinder
