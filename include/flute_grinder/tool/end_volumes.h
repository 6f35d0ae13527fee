#pragma once

#include "flute_grinder/curve/face_stroke.h"
#include "flute_grinder/tool/removed_volume.h"

#include <map>
#include <vector>

namespace grinder {

class ValidJob;

/// Strokes on the end of a tool, by the number of the tooth.
using EndStrokes = std::multimap<int, FaceStroke>;

/// What operations on the end take from a tool.
struct EndVolumes {
  double blank_x = 0;  ///< X of the blank's flat end, 0 or less [m]
  std::vector<RemovedVolume> removed;
};

/// The deepest strokes of a job on the end, as planned.
/// @param job job from withLaws().
EndStrokes plannedStrokes(const ValidJob& job);

/// What the operations of the list up to a job's take from the end: nothing for a tool that they leave as it is.
/// @param job job from withLaws().
/// @param own strokes of the job's own operation if it is on the end; those of the operations before are as planned.
EndVolumes endVolumesOf(const ValidJob& job, const EndStrokes& own);

/// As planned.
EndVolumes endVolumesOf(const ValidJob& job);

}  // namespace grinder
