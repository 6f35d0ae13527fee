#pragma once

#include "flute_grinder/tool/cutter_solid.h"

namespace grinder {

/// Joins the pieces of a cut surface: corners that are one but for rounding, up to 1 um apart where planes are nearly
/// parallel, become one, and a corner on another triangle's edge divides that triangle. A chip that does not hang
/// together with the end of the shank goes. Counts CutterSolid::open_edges.
void closeSeams(CutterSolid& solid);

}  // namespace grinder
