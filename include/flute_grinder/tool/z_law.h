#pragma once

#include "flute_grinder/motion/job_plan.h"

#include <vector>

namespace grinder {

class ValidJob;
struct EdgeHelix;

/// A job with the laws that depend on the ground cutter. For kConstantRake these are corrections of Z, one for each
/// tooth, that keep the rake as asked within kEvenRake over the whole flute, with the wheel of the job's start and the
/// stroke of full depth; they take some tenths of a second for each distinct spiral angle. For other operations
/// they are the ground edges of all teeth; the flutes under them have passes only if the wheel wears in these. A job
/// whose roughing passes follow from what they remove gets them by withPasses(). The same job gives the same bits.
/// @param watch if given, it may stop the computation, within some milliseconds.
/// @throw ReasonError if no correction keeps the rake, if a tooth has no edge, or if it was stopped.
/// @throw like wheelOf() and withPasses().
ValidJob withLaws(const ValidJob& job, const PlanWatch& watch = {});

/// The helices of the teeth's ground edges.
/// @param flutes job of the flutes, with its laws.
/// @throw ReasonError if a tooth has no edge.
std::vector<EdgeHelix> edgesOf(const ValidJob& flutes);

}  // namespace grinder
