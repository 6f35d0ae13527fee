#pragma once

#include "flute_grinder/geometry/job_setup.h"

#include <string>

namespace grinder {

/// What a set-up changes in its job's file, a line for each figure: what the file has, what was solved, and the
/// difference, in the file's units. @throw JobFileError if the file cannot be read.
std::string changesText(const std::string& path, const JobSetup& setup);

/// Writes a set-up into its job's file: the old file or the new one, never a part, whatever fails. Comments, order,
/// layout, permissions and a link to the file stay. What was in the file before is kept beside it, in a file of its
/// name and the suffix `.before`.
/// @throw JobFileError if the file cannot be edited or written, or is no longer the job that was solved; the text says
///        what to write by hand.
void writeSetup(const std::string& path, const JobSetup& setup);

}  // namespace grinder
