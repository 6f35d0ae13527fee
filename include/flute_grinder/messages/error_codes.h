#pragma once

#include "flute_grinder/machine/loop_fault.h"
#include "flute_grinder/motion/job_plan.h"

namespace grinder {

/// The GrindResult code for a refused plan.
int errorCode(PlanFault fault);
/// The GrindResult code for a fault that ended a job.
int errorCode(FaultKind fault);

}  // namespace grinder
