#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/core/job_plan.h"

#include <nlohmann/json.hpp>

namespace flute_grinder {

/// What `--json` prints: keys in a fixed order, with the operator's unit in the name; numbers to full precision.
using Json = nlohmann::ordered_json;

/// For `grind plan`: whether the job can be ground, why not, and its statistics.
Json toJson(const JobPlan& plan);

/// For `grind status`. Teeth and passes count from 1, as on the operator's screens. @param node resolved name.
Json toJson(const std::string& node, const GrinderState& state);

/// As it is printed; bytes that are not UTF-8 are replaced.
std::string text(const Json& json);

/// Prints it to stdout.
void print(const Json& json);

}  // namespace flute_grinder
