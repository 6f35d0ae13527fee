#pragma once

#include "flute_grinder/motion/job_plan.h"

namespace grinder {

class ValidJob;

/// A job with what it needs to know of Z: for kConstantRake, the correction of Z with which the rake is as asked within
/// kEvenRake over the whole flute, for each tooth; for kPublished none. The wheel is that of the job's start, the
/// stroke that of the full depth. Takes some tenths of a second for each distinct spiral angle. The same job gives the
/// same bits.
/// @param watch if given, may make it give up, within some milliseconds.
/// @throw ReasonError if no correction keeps the rake, or if it has given up. @throw as wheelOf().
ValidJob withZLaw(const ValidJob& job, const PlanWatch& watch = {});

}  // namespace grinder
