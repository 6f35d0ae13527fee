#pragma once

#include <string>

namespace grinder {

/// Arguments of `grind history --figure`.
struct FigureHistoryOptions {
  std::string figure;     ///< FIGURE or FIGURE@X; empty for a list of records instead
  std::string job;        ///< job file of the tools
  std::string operation;  ///< one of several operations; empty for the only one
  std::string svg;        ///< file to write; empty for none
};

/// Prints a figure over the tools of a job, and draws it.
/// @param node see historyFolder(). @param folder of the records; empty for the default folder of the grinder.
/// @return the exit status. @throw FileError, std::invalid_argument
int printFigureHistory(const std::string& node, const std::string& folder, const FigureHistoryOptions& options,
                       bool json);

}  // namespace grinder
