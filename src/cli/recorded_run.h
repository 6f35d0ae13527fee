#pragma once

#include "flute_grinder/geometry/run_strokes.h"
#include "flute_grinder/report/bag_run.h"

#include <optional>
#include <string>

namespace grinder {

/// The cutter as the operations ahead of a relief in a bag ground it, by their runs in the same bag.
/// @param path of the bag. @return nothing if BagRun::before() is empty.
/// @throw FileError, std::invalid_argument if a run cannot be read, or is not of its job; ReasonError for a job
///        without a law of Z.
std::optional<GroundCutter> recordedBefore(const std::string& path, const BagRun& run);

/// Where that comes from, for the reader, to be put behind the run's place; empty for flutes.
std::string recordedBeforeText(const BagRun& run);

}  // namespace grinder
