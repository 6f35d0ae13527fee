#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace grinder {

/// Arguments of `grind measured`.
struct MeasuredOptions {
  std::string job;
  std::string operation;             ///< one of several operations; empty for the only one
  std::vector<std::string> figures;  ///< texts for measuredFrom()
  std::uint64_t tool = 0;            ///< number of its record; 0 for the last tool of the job
  std::string folder;                ///< folder of the records; empty for the default folder of the grinder
};

/// Appends what was measured of a ground tool to its record. @param node see historyFolder(). @return the exit status.
/// @throw FileError, std::invalid_argument; nothing is then written.
int keepMeasured(const std::string& node, const MeasuredOptions& options);

}  // namespace grinder
