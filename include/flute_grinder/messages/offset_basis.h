#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/OffsetBasis.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/machine/offset_fit.h"
#include "flute_grinder/messages/json.h"

#include <string>
#include <vector>

/// @file
/// The values of a goal that its zero points depend on, and the fit of work offsets to them.
namespace grinder {

struct JobFile;

/// The goal of a job file, with the names of the file and of its wheel file.
/// @throw FileError if a file cannot be read.
flute_grinder::GrindGoal goalFromFile(const std::string& path, const std::string& operation = "");
flute_grinder::GrindGoal goalFromFile(const JobFile& file);

/// The basis of a work offset that is set for a goal.
OffsetBasis basisOf(const flute_grinder::GrindGoal& goal, OffsetMethod method);

/// The basis for files and the command line, in mm and deg; its numbers are null if it was set for no particular job.
Json toJson(const OffsetBasis& basis);

flute_grinder::OffsetBasis toMessage(const OffsetBasis& basis);
/// @return an unknown method if the message has an invalid one.
OffsetBasis fromMessage(const flute_grinder::OffsetBasis& message);
WorkOffsets fromMessage(const flute_grinder::WorkOffsets& message);
/// Everything except the stamp and `error`.
flute_grinder::WorkOffsets toMessage(const WorkOffsets& offsets);

/// The work offsets that do not fit a goal.
std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const flute_grinder::GrindGoal& goal);

}  // namespace grinder
