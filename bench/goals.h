#pragma once

#include "flute_grinder/GrindGoal.h"

namespace grinder {

/// As the jobs of jobs.h.
flute_grinder::GrindGoal paperGoal();
flute_grinder::GrindGoal wholeToolGoal();

}  // namespace grinder
