#pragma once

#include <string>

namespace flute_grinder {

/// Arguments of `grind report`.
struct ReportOptions {
  std::string file;        ///< points, setpoints (CSV), or a bag
  std::string output;      ///< HTML
  int job = 0;             ///< which of a bag's jobs, from 1; 0 for the last
  std::string parameters;  ///< YAML of the machine, whose limits are drawn
  std::string urdf;
};

/// Writes a report: gives this process to the program in Python that draws it.
/// @throw FileError or ParameterError for a machine that cannot be read, FileError if there is no such program.
[[noreturn]] void writeReport(const ReportOptions& options);

}  // namespace flute_grinder
