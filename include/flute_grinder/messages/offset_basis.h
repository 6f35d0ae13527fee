#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/OffsetBasis.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/machine/offset_fit.h"
#include "flute_grinder/messages/json.h"

#include <string>
#include <vector>

/// @file
/// Which figures of a goal its zero points depend on, and whether work offsets were set for them.
namespace flute_grinder {

/// The goal of a job file, with the names of the file and its wheel file. @throw JobFileError
GrindGoal goalFromFile(const std::string& path);

/// What a work offset is set for that is set for a goal.
core::OffsetBasis basisOf(const GrindGoal& goal, OffsetMethod method);

/// For files and the command line, in mm and deg; null for the figures if it was set for no particular job.
Json toJson(const core::OffsetBasis& basis);

OffsetBasis toMessage(const core::OffsetBasis& basis);
/// @return an unknown method if the message has an invalid one.
core::OffsetBasis fromMessage(const OffsetBasis& message);
core::WorkOffsets fromMessage(const WorkOffsets& message);

/// The work offsets that do not fit a goal.
std::vector<core::OffsetMismatch> mismatches(const core::WorkOffsets& offsets, const GrindGoal& goal);

/// What a dry run or a plan says of them: nothing, or one text.
std::vector<std::string> offsetWarnings(const core::WorkOffsets& offsets, const GrindGoal& goal);

/// Why offsets do not fit and what to do about it, for the operator; empty if all fit.
std::string text(const std::vector<core::OffsetMismatch>& mismatches);

/// The axes among them whose offset can be computed, e.g. "Y and Z".
std::string computable(const std::vector<core::OffsetMismatch>& mismatches);

}  // namespace flute_grinder
