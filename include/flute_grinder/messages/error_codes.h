#pragma once

#include "flute_grinder/core/job_plan.h"
#include "flute_grinder/core/loop_fault.h"

namespace flute_grinder {

/// The GrindResult code for a refused plan.
int errorCode(PlanFault fault);
/// The GrindResult code for a fault that ended a job.
int errorCode(FaultKind fault);

}  // namespace flute_grinder
