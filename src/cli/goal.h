#pragma once

#include <string>

namespace grinder {

/// Writes the goal that `grind run` sends for a job file to stdout, as ROS serializes it. @return the exit status.
/// @throw FileError @throw std::invalid_argument if stdout is a terminal.
int writeGoal(const std::string& job, const std::string& operation);

}  // namespace grinder
