#pragma once

#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/run_strokes.h"

namespace grinder {

/// Measures the end that a job's operation leaves: clearances, dish, rake, land and chamfer are within the job's
/// tolerances, edges are whole outside the uncut diameter, nothing stands in front of them, and the periphery's edge is
/// untouched. Before a gash, the primary flank that follows it is taken as planned, if it can be: its edge shows which
/// teeth the gash spoils. Teeth that are alike are measured once. Takes some milliseconds.
/// @param job job of an operation on the end, from withLaws().
/// @throw like wheelOf().
CutterCheck checkGroundEnd(const ValidJob& job);

/// The same for the end that a run has ground, on the others as planned.
CutterCheck checkGroundEnd(const RunStrokes& run);

}  // namespace grinder
