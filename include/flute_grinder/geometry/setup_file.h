#pragma once

#include "flute_grinder/geometry/job_setup.h"

#include <string>

namespace grinder {

/// Writes a set-up into its job's file: the old file or the new one, never a part, whatever fails. Comments, order,
/// layout, permissions and a link to the file stay.
/// @throw JobFileError if the file cannot be edited or written, or is no longer the job that was solved; the text says
///        what to write by hand.
void writeSetup(const std::string& path, const JobSetup& setup);

}  // namespace grinder
