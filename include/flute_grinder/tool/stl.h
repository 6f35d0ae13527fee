#pragma once

#include "flute_grinder/tool/cutter_solid.h"

#include <ostream>

namespace grinder {

/// Writes a solid as binary STL in millimetres: the format has no units, and millimetres are customary. Leaves out
/// triangles with two corners equal in single precision. The stream's state tells whether it succeeded.
/// @param out stream opened in binary mode.
/// @throw std::invalid_argument if the solid has open edges.
void writeStl(std::ostream& out, const CutterSolid& solid);

}  // namespace grinder
