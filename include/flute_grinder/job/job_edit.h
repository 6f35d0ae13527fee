#pragma once

#include "flute_grinder/job/job_file.h"

#include <string>
#include <vector>

namespace grinder {

/// A number to write into a job file.
struct JobEdit {
  std::string key;    ///< key in the file, e.g. "process.setup.swivel_deg" or "process.overtravel_mm[0]"
  std::string value;  ///< text of the new value, in the key's unit
};

/// The text of a job file with some numbers changed. A missing key is inserted, and so is a missing map around it.
/// Every other byte stays: comments, order, layout, line ends, and numbers that already have the value.
/// @param text text of a valid job file.
/// @param name name of the file in messages.
/// @throw JobFileError naming the line if the text cannot be edited safely: anchors, aliases, a tag at a number to
///        change, several documents, or text that is not UTF-8.
std::string editJob(const std::string& text, const std::string& name, const std::vector<JobEdit>& edits);

}  // namespace grinder
