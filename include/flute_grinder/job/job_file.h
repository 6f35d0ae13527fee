#pragma once

#include "flute_grinder/job/yaml_text.h"

#include <string>
#include <vector>

namespace grinder {

struct GrindJob;

/// Reads and checks a job from a YAML file in the operator's units (mm, deg, mm/min), with its wheel from the wheel
/// file that it may name, relative to the job file.
/// @param path the file.
/// @param unsolved fields that the file may omit because they are yet to be found, for this operation and those after
///        it: process.setup_swivel and process.setup_height, which are then 0, and process.depth, which is then the
///        depth that leaves the asked core under an upright wheel.
/// @param operation the job's operation if there are several: its number, from 1, or its kind, e.g. "primary".
/// @return the job in SI.
/// @throw JobFileError if the file cannot be read, a key is missing, unknown or duplicated, or a value has the wrong
///        type, is not finite or is not allowed.
GrindJob readJobFile(const std::string& path, const std::vector<std::string>& unsolved = {},
                     const std::string& operation = "");

/// Reads and checks a job from text; `name` is the file in messages, and a wheel file is relative to its folder.
GrindJob parseJob(const std::string& text, const std::string& name, const std::vector<std::string>& unsolved = {},
                  const std::string& operation = "");

/// The path of the wheel file that an operation of a job file names; empty if it names none.
/// @param operation index, from 0.
/// @throw JobFileError if the file cannot be read.
std::string wheelFileOf(const std::string& path, int operation = 0);

}  // namespace grinder
