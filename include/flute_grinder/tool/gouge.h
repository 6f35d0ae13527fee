#pragma once

#include "flute_grinder/tool/run_strokes.h"

#include <vector>

namespace grinder {

/// The depth to which a move of a run cut into the tool that the job asks for.
struct Gouge {
  ToothPass place;
  MoveKind move = MoveKind::kStroke;
  double x = 0;      ///< X of the section in which the gouge is deepest; 0 on the end [m]
  double depth = 0;  ///< depth normal to the asked flute [m]
};

/// The gouges of a run, the deepest of each move, in the order of RunStrokes::strokes(). Measures the sections where
/// the axes were farthest off the path and some in between, from the small end up to the overtravel.
/// @param strokes finished strokes.
/// @param min minimum depth of a gouge [m].
std::vector<Gouge> gougesOf(const RunStrokes& strokes, double min);

}  // namespace grinder
