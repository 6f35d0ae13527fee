#pragma once

#include "flute_grinder/tool/end_volumes.h"
#include "tool/ground_end.h"

#include <vector>

namespace grinder {

/// The strokes on the end of a tool, in the order of the operations.
struct EndCuts {
  double blank_x = 0;  ///< X of the blank's flat end, 0 or less [m]
  std::vector<EndCut> cuts;
};

/// The strokes of all operations on the end up to a job's, as for endVolumesOf().
EndCuts endCutsOf(const ValidJob& job, const EndStrokes& own);

/// Adds the strokes of a job on the end.
void addCuts(const ValidJob& job, const EndStrokes& strokes, std::vector<EndCut>& cuts);

}  // namespace grinder
