#pragma once

#include "flute_grinder/messages/json.h"
#include "flute_grinder/tool/run_strokes.h"

#include <vector>

/// @file
/// The path of the wheel in a job, as kept in its record: for each stroke, the deviations of the axes from their path,
/// to 1 nm and 1 nrad. The tool is computed from it.
namespace grinder {

Json toJson(const std::vector<RunStroke>& strokes);

/// @throw std::exception for JSON that toJson() does not write.
std::vector<RunStroke> runStrokesFrom(const Json& json);

}  // namespace grinder
