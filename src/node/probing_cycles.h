#pragma once

#include "flute_grinder/ProbeGoal.h"
#include "flute_grinder/ProbeResult.h"
#include "flute_grinder/machine/probing_cycle.h"
#include "flute_grinder/motion/work_offsets.h"
#include "node/prober.h"

#include <string>

namespace grinder {

/// Why a goal is wrong whatever the state; empty if it is right.
std::string goalRefusal(const flute_grinder::ProbeGoal& goal);

/// Runs a cycle. @param goal a goal that goalRefusal() accepts. @param offsets the work offsets.
/// @param result gets the figures as they are measured.
/// @return the work offset of the cycle's axis; NaN unless goal.set_offset [m], A [rad]
/// @throw ProbingError; ReasonError
double runCycle(Prober& prober, const flute_grinder::ProbeGoal& goal, const WorkOffsets& offsets,
                flute_grinder::ProbeResult& result);

}  // namespace grinder
