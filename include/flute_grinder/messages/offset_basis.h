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
namespace grinder {

/// The goal of a job file, with the name of the file and what is said of its wheel file. @throw JobFileError
flute_grinder::GrindGoal goalFromFile(const std::string& path, const std::string& operation = "");
/// @param job that was read from the file.
flute_grinder::GrindGoal goalFromFile(const std::string& path, const GrindJob& job);

/// What a work offset is set for that is set for a goal.
OffsetBasis basisOf(const flute_grinder::GrindGoal& goal, OffsetMethod method);

/// For files and the command line, in mm and deg; null for the figures if it was set for no particular job.
Json toJson(const OffsetBasis& basis);

flute_grinder::OffsetBasis toMessage(const OffsetBasis& basis);
/// @return an unknown method if the message has an invalid one.
OffsetBasis fromMessage(const flute_grinder::OffsetBasis& message);
WorkOffsets fromMessage(const flute_grinder::WorkOffsets& message);
/// All but its stamp and `error`.
flute_grinder::WorkOffsets toMessage(const WorkOffsets& offsets);

/// The work offsets that do not fit a goal.
std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const flute_grinder::GrindGoal& goal);

/// What a dry run or a plan says of them: nothing, or one text.
std::vector<std::string> offsetWarnings(const WorkOffsets& offsets, const flute_grinder::GrindGoal& goal);

/// Why offsets do not fit and what to do about it, for the operator; empty if all fit.
std::string text(const std::vector<OffsetMismatch>& mismatches);

/// The axes among them whose offset can be computed, e.g. "Y and Z".
std::string computable(const std::vector<OffsetMismatch>& mismatches);

}  // namespace grinder
