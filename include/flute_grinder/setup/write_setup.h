#pragma once

#include "flute_grinder/job/job_file.h"

#include <string>

namespace grinder {

/// Refuses a job file that states the figures of its set-up itself.
/// @throw FileError that says how a job file names a set-up file.
void requireSetupFile(const JobFile& asked);

/// Writes a solved set-up into its set-up file, in one step.
/// @param solved job with its set-up.
/// @throw FileError if the job file names no set-up file, or if the file cannot be written or is another job's.
void writeSetup(const JobFile& asked, const GrindJob& solved);

}  // namespace grinder
