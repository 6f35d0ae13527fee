#pragma once

#include "flute_grinder/job/yaml_text.h"

#include <string>
#include <vector>

namespace grinder {

struct GrindJob;

/// Reads and checks a job from a YAML file in the operator's units (mm, deg, mm/min), with its wheel from the wheel
/// file that it may name, relative to the job file.
/// @param path the file.
/// @param unsolved fields that the file may omit because they are yet to be found: process.setup_swivel,
///        process.setup_height, which are then 0, and process.depth, which is then what leaves the asked core under an
///        upright wheel; only of the operation, and of those behind it.
/// @param operation which of several operations the job is: its number, from 1, or its kind, e.g. "primary".
/// @return the job in SI.
/// @throw JobFileError if the file cannot be read, a key is missing, unknown or duplicated, or a value has the wrong
///        type, is not finite or is not allowed.
GrindJob readJobFile(const std::string& path, const std::vector<std::string>& unsolved = {},
                     const std::string& operation = "");

/// The same from text; `name` is the file in messages, and a wheel file is relative to its folder.
GrindJob parseJob(const std::string& text, const std::string& name, const std::vector<std::string>& unsolved = {},
                  const std::string& operation = "");

/// The path of the wheel file that an operation of a job file names; empty if it names none. @param operation from 0.
/// @throw JobFileError
std::string wheelFileOf(const std::string& path, int operation = 0);

}  // namespace grinder
