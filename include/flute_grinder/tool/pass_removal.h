#pragma once

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/job_plan.h"

#include <cstddef>
#include <vector>

namespace grinder {

/// What a pass of an operation removes.
struct PassRemoval {
  double depth = 0;   ///< as in ValidJob::depths() [m]
  double area = 0;    ///< from a section of a tooth: the largest of those amid the flute and at both ends [m^2]
  double rate = 0;    ///< the largest product of such an area and the axial speed of its tooth at the feed [m^3/s]
  double volume = 0;  ///< from all teeth, over the length of the flute [m^3]
};

constexpr std::size_t kMaxMeasuredPasses = 100;  ///< passes of a tooth above which none is measured

/// Measures what each pass of a tooth removes. Takes some tenths of a second.
/// @param job job from withLaws().
/// @param watch if given, it may stop the computation, within some milliseconds; several threads call it.
/// @return one for each of ValidJob::depths(); empty for an operation on the end, and for too many passes.
/// @throw ReasonError if it was stopped.
/// @throw like wheelOf().
std::vector<PassRemoval> removalOfPasses(const ValidJob& job, const PlanWatch& watch = {});

/// The job with its passes. Where these follow from what they remove, the roughing passes remove equal amounts per
/// second, each measured where it is largest: at the flute's ends or amid it. A pass that would remove nothing is left
/// out. That takes some tenths of a second for each distinct tooth; the same job gives the same bits.
/// @param job job with its law of Z, or with its edges.
/// @param watch if given, it may stop the computation, within some milliseconds.
/// @throw ReasonError if the job's removal would take too many passes, or if it was stopped.
/// @throw like wheelOf() and ValidJob::withRoughing().
ValidJob withPasses(const ValidJob& job, const PlanWatch& watch = {});

}  // namespace grinder
