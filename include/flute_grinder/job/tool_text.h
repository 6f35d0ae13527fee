#pragma once

#include "flute_grinder/job/cutter_geometry.h"

#include <cstddef>
#include <string>

namespace grinder {

/// The tool in words for people, in shop units, e.g. "D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth".
std::string toolText(const CutterGeometry& cutter, std::size_t teeth);

/// A job with its tool, for people.
/// @param name name of the job's file; may be empty.
/// @param operation see GrindJob::operationText().
std::string jobText(const std::string& name, const std::string& operation, const CutterGeometry& cutter,
                    std::size_t teeth);

}  // namespace grinder
