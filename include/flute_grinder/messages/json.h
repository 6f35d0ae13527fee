#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/motion/job_plan.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace grinder {

struct GrindJob;
struct PassRemoval;

/// JSON output: keys in a fixed order, with the operator's unit in the name; numbers to full precision.
#if NLOHMANN_JSON_VERSION_MAJOR > 3 || NLOHMANN_JSON_VERSION_MINOR >= 9
using Json = nlohmann::ordered_json;
#else  // as in Ubuntu 20.04: in the order of the alphabet
using Json = nlohmann::json;
#endif

/// One number per axis, in mm and deg, with the units in the names.
/// @param per_time end of the names, e.g. "_s" for velocities.
Json toJson(const Axes& value, const std::string& per_time);

/// The causes that keep the feed of a plan below the programmed feed, and their places.
Json toJson(const std::vector<FeedLimit>& limits);

/// What the passes of an operation remove.
Json toJson(const std::vector<PassRemoval>& passes);

/// A job in the keys and units of a job file. Written as YAML it is a job file, and reading that gives the same job, to
/// the last bit if the job came from a file. A wheel that has a file of its own is written inline.
Json toJson(const GrindJob& job);

/// Replaces all texts by their escaped() form.
void escapeTexts(Json& json);

/// The text of a JSON value. Bytes that are not UTF-8 are replaced.
/// @param indent indent of each level; -1 for a single line.
std::string text(const Json& json, int indent = 2);

}  // namespace grinder
