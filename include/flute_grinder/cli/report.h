#pragma once

#include <string>

namespace flute_grinder {

/// Arguments of `grind report`.
struct ReportOptions {
  std::string file;        ///< points, setpoints (CSV), or a bag
  std::string output;      ///< HTML
  int job = 0;             ///< which of a bag's jobs, from 1; 0 for the last
  std::string parameters;  ///< YAML of the machine whose limits are drawn
  std::string urdf;
};

/// Writes a report: replaces this process by the Python program that draws it.
/// @throw FileError or ParameterError if the machine cannot be read, FileError if the program is missing.
[[noreturn]] void writeReport(const ReportOptions& options);

/// Draws a tool into an SVG file. @param json what `grind simulate --json` prints. @return whether that succeeded; the
/// reason is on stderr. @throw FileError if the program is missing.
bool drawTool(const std::string& json, const std::string& svg);

}  // namespace flute_grinder
