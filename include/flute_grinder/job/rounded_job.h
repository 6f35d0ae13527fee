#pragma once

#include "flute_grinder/job/grind_job.h"

namespace grinder {

/// A job with all its numbers rounded to nine digits in shop units, as the input of a fit: between solutions that are
/// almost equally good, the last bits of a number would otherwise decide, and the same tool would get different ones.
GrindJob roundedOff(GrindJob job);

}  // namespace grinder
