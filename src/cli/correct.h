#pragma once

#include <cstdint>
#include <string>

namespace grinder {

/// Arguments of `grind correct`.
struct CorrectOptions {
  std::string job;
  std::string operation;    ///< one of several operations; empty for the only one
  std::uint64_t since = 0;  ///< number of the first tool that counts; 0 for the first with the zero points of the last
  std::string folder;       ///< folder of the records; empty for the default folder of the grinder
  std::string parameters;   ///< YAML of the machine
  std::string urdf;
  bool json = false;
};

/// Prints what the measured tools of a job say of its set-up, and what to set so that the next tool is as planned.
/// Moves and sets nothing. @param node see historyFolder().
/// @return the exit status: 1 if the last measured tool is a surprise, so that nothing should be set by it.
/// @throw FileError, std::invalid_argument
int printCorrection(const std::string& node, const CorrectOptions& options);

}  // namespace grinder
