#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/messages/json.h"

namespace grinder {

/// The figures of a tool, and the figures that its job asks for; null where there is no figure or nothing is asked.
Json toJson(const CutterFigures& figures);

/// The output of `grind plan --json`: whether the job can be ground, why not, and its statistics.
Json toJson(const PlannedJob& plan);

/// The output of `grind status --json`. Teeth and passes count from 1, as on the operator's screens. @param node
/// resolved name.
/// @param offsets null if unknown.
Json toJson(const std::string& node, const flute_grinder::GrinderState& state,
            const flute_grinder::WorkOffsets::ConstPtr& offsets);

/// Prints JSON to stdout.
void print(const Json& json);

}  // namespace grinder
