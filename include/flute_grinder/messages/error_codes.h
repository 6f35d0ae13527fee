#pragma once

#include "flute_grinder/core/job_plan.h"
#include "flute_grinder/core/loop_fault.h"

namespace flute_grinder {

/// The code of GrindResult for a plan that is refused.
int errorCode(PlanFault fault);
/// The code of GrindResult for a fault that ended a job.
int errorCode(FaultKind fault);

}  // namespace flute_grinder
