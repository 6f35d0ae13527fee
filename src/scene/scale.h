#pragma once

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/scene/markers.h"

#include <string>

namespace grinder {

/// Appends a scale in mm along the flutes, in the frame `work` in front of the tool, and below it what is shown and
/// how long the flutes are.
/// @param cutter of a valid job.
void appendScale(visualization_msgs::MarkerArray& array, const CutterGeometry& cutter, const std::string& shown);

}  // namespace grinder
