#pragma once

#include "flute_grinder/geometry/run_strokes.h"

#include <vector>

namespace grinder {

/// How far a move of a run went into what its job leaves of the blank.
struct Gouge {
  ToothPass place;
  MoveKind move = MoveKind::kStroke;
  double x = 0;      ///< of the section in which it is deepest [m]
  double depth = 0;  ///< normal to the flute that the job asks for [m]
};

/// The gouges of a run, each the deepest of its move, in the order of RunStrokes::strokes(). Looks at sections
/// where the axes were farthest off the path and at some in between, from the small end up to the overtravel.
/// @param strokes finished. @param min depth that counts [m].
std::vector<Gouge> gougesOf(const RunStrokes& strokes, double min);

}  // namespace grinder
