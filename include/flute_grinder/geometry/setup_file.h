#pragma once

#include "flute_grinder/geometry/job_setup.h"

#include <string>

namespace grinder {

/// The changes of a set-up in its job's file, a line for each figure: the file's value, the solved value, and the
/// difference, in the file's units.
/// @throw JobFileError if the file cannot be read.
std::string changesText(const std::string& path, const JobSetup& setup);

/// Writes a set-up into its job's file atomically. Comments, order, layout, permissions and a link to the file stay. A
/// copy of the old file is kept beside it, with the suffix `.before`.
/// @throw JobFileError if the file cannot be edited or written, or is no longer the job that was solved; the text says
///        what to write by hand.
void writeSetup(const std::string& path, const JobSetup& setup);

}  // namespace grinder
