#pragma once

#include "flute_grinder/job/job_file.h"

#include <string>
#include <vector>

namespace grinder {

/// A number to write into a job file.
struct JobEdit {
  std::string key;    ///< in the file, e.g. "process.setup.swivel_deg" or "process.overtravel_mm[0]"
  std::string value;  ///< as it shall be read there, in the key's unit
};

/// The text of a job file with some numbers changed. A key that is missing is inserted, with the map around it if that
/// is missing too. Every other byte stays: comments, order, layout, line ends, and numbers that already have the value.
/// @param text of a job file that can be read.
/// @param name replaces the file name in messages.
/// @throw JobFileError naming the line if the text cannot be edited without risk: with anchors, aliases, tags at a
///        number to change, several documents, or where it is not the UTF-8 that it is read as.
std::string editJob(const std::string& text, const std::string& name, const std::vector<JobEdit>& edits);

}  // namespace grinder
