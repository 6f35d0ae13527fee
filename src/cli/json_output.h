#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/plan/planned_job.h"

namespace flute_grinder {

/// For `grind plan`: whether the job can be ground, why not, and its statistics.
/// @param shank_cut see shankCut() [m].
Json toJson(const PlannedJob& plan, double shank_cut);

/// For `grind status`. Teeth and passes count from 1, as on the operator's screens. @param node resolved name.
/// @param offsets null if they are not known.
Json toJson(const std::string& node, const GrinderState& state, const WorkOffsets::ConstPtr& offsets);

/// Prints it to stdout.
void print(const Json& json);

}  // namespace flute_grinder
