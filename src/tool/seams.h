#pragma once

#include "flute_grinder/tool/cutter_solid.h"

namespace grinder {

/// Joins the pieces of a cut surface: corners that differ by rounding become one, and a corner on another triangle's
/// edge divides that triangle. A chip that does not hang together with the end of the shank goes.
/// @throw std::invalid_argument if the surface does not close.
void closeSeams(CutterSolid& solid);

}  // namespace grinder
