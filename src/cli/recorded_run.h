#pragma once

#include "flute_grinder/report/bag_run.h"
#include "flute_grinder/tool/run_strokes.h"

#include <optional>
#include <string>

namespace grinder {

/// The cutter that the operations before a relief have ground, from their runs in the same bag.
/// @param path of the bag. @return nothing if BagRun::before() is empty.
/// @throw FileError, std::invalid_argument if a run cannot be read or does not belong to its job; ReasonError for a
///        job without a law of Z.
std::optional<GroundCutter> recordedBefore(const std::string& path, const BagRun& run);

/// The source of recordedBefore() as text to follow the run's place; empty for flutes.
std::string recordedBeforeText(const BagRun& run);

}  // namespace grinder
