#pragma once

#include "flute_grinder/motion/job_plan.h"

#include <vector>

namespace grinder {

class ValidJob;
struct EdgeHelix;

/// A job with what its strokes take from the ground cutter. For kConstantRake that is the correction of Z with which
/// the rake is as asked within kEvenRake over the whole flute, for each tooth: with the wheel of the job's start and
/// the stroke of the full depth. It takes some tenths of a second for each distinct spiral angle. For a relief it is
/// the edge of every tooth as the flutes leave it. The same job gives the same bits.
/// @param watch if given, may make it give up, within some milliseconds.
/// @throw ReasonError if no correction keeps the rake, if a tooth has no edge, or if it has given up. @throw as
/// wheelOf().
ValidJob withLaws(const ValidJob& job, const PlanWatch& watch = {});

/// The helices of the teeth's edges as the flutes leave them.
/// @param flutes with their laws. @throw ReasonError if a tooth has no edge.
std::vector<EdgeHelix> edgesOf(const ValidJob& flutes);

}  // namespace grinder
