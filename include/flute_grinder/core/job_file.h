#pragma once

#include "flute_grinder/core/grind_job.h"

#include <stdexcept>
#include <string>

namespace flute_grinder {

/// A job file that cannot be read; what() has a line for each error: file, line, key, value and what is allowed.
class JobFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads and checks a job from a YAML file in the operator's units (mm, deg, mm/min).
/// @param path the file.
/// @return the job in SI.
/// @throw JobFileError where the file cannot be read, a key is missing, unknown or doubled, or a value is of the wrong
/// type,
///        not finite or not allowed.
GrindJob readJobFile(const std::string& path);

/// The same from text; `name` stands for the file in messages.
GrindJob parseJob(const std::string& text, const std::string& name);

}  // namespace flute_grinder
