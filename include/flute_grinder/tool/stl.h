#pragma once

#include "flute_grinder/tool/cutter_solid.h"

#include <string>

namespace grinder {

/// A solid as binary STL in millimetres: the format has no units, and millimetres are customary. Leaves out triangles
/// with two corners equal in single precision.
/// @return the bytes of the file.
/// @throw std::invalid_argument if the solid has open edges.
std::string stlOf(const CutterSolid& solid);

}  // namespace grinder
