#pragma once

#include "flute_grinder/core/grind_job.h"

#include <stdexcept>
#include <string>

namespace flute_grinder {

/// A job file that cannot be read; what() has one line per error: file, line, key, value and the allowed values.
class JobFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads and checks a job from a YAML file in the operator's units (mm, deg, mm/min).
/// @param path the file.
/// @return the job in SI.
/// @throw JobFileError if the file cannot be read, a key is missing, unknown or duplicated, or a value has the wrong
///        type, is not finite or is not allowed.
GrindJob readJobFile(const std::string& path);

/// The same from text; `name` replaces the file name in messages.
GrindJob parseJob(const std::string& text, const std::string& name);

}  // namespace flute_grinder
