#pragma once

#include "flute_grinder/tool/ground_cutter.h"

namespace grinder {

/// Measures the reliefs of a tooth of a cutter.
/// @param section section of the cutter, in which all teeth have an edge.
/// @param reliefs not empty; for a tooth at angle 0.
ReliefSection measureRelief(const GroundCutter& cutter, const GroundSection& section, std::size_t tooth,
                            const Reliefs& reliefs);

}  // namespace grinder
