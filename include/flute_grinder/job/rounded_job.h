#pragma once

#include "flute_grinder/job/grind_job.h"

namespace grinder {

/// A job with all its numbers rounded to nine digits in shop units, for what is fitted to them: of solutions that are
/// equally good, or all but, the last bits of a number would choose another one for the same tool.
GrindJob roundedOff(GrindJob job);

}  // namespace grinder
