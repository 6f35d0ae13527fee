#pragma once

#include "flute_grinder/geometry/cutter_solid.h"

#include <ostream>

namespace grinder {

/// Writes a solid as binary STL, in millimetres: the format has no units, and the trade takes millimetres. Triangles
/// of which two corners are the same as single-precision numbers are left out. The stream says whether that succeeded.
/// @param out opened in binary mode.
void writeStl(std::ostream& out, const CutterSolid& solid);

}  // namespace grinder
