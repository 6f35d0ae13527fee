#pragma once

#include "flute_grinder/geometry/run_strokes.h"
#include "flute_grinder/messages/json.h"

#include <vector>

/// @file
/// Where the wheel went in a job, as its record keeps it: of each stroke how far the axes were off their path, to 1 nm
/// and 1 nrad. From this the tool is computed again.
namespace grinder {

Json toJson(const std::vector<RunStroke>& strokes);

/// @throw std::exception for what toJson() does not write.
std::vector<RunStroke> runStrokesFrom(const Json& json);

}  // namespace grinder
