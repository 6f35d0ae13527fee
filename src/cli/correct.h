#pragma once

#include <cstdint>
#include <string>
#include <vector>

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
  bool apply = false;                ///< set the work offsets
  std::vector<std::string> answers;  ///< answers given beforehand
};

/// Prints what the measured tools of a job say of its set-up, and what to set so that the next tool is as planned; sets
/// the work offsets of Y and Z if asked to. @param node name of the grinder's node, see also historyFolder().
/// @return the exit status: 1 if the last measured tool is a surprise, so that nothing is set by it.
/// @throw FileError, std::invalid_argument
int correct(const std::string& node, const CorrectOptions& options);

}  // namespace grinder
