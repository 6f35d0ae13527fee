#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/plan/planned_job.h"

namespace grinder {

/// What a tool gets, and what its job asks for; null where there is none, or nothing is asked.
Json toJson(const CutterFigures& figures);

/// For `grind plan`: whether the job can be ground, why not, and its statistics.
Json toJson(const PlannedJob& plan);

/// For `grind status`. Teeth and passes count from 1, as on the operator's screens. @param node resolved name.
/// @param offsets null if they are not known.
Json toJson(const std::string& node, const flute_grinder::GrinderState& state,
            const flute_grinder::WorkOffsets::ConstPtr& offsets);

/// Prints it to stdout.
void print(const Json& json);

}  // namespace grinder
