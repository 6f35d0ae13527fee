#pragma once

#include "cli/output_file.h"

#include <string>

namespace grinder {

/// Arguments of `grind report`.
struct ReportOptions {
  std::string file;           ///< a bag, or a record of the grinder
  bool last = false;          ///< the newest record of the grinder instead
  std::string folder;         ///< of these records; empty for the default folder of the grinder
  std::string html;           ///< file to write; empty for none
  std::string pdf;            ///< file to write; empty for none
  bool json = false;          ///< print the data
  std::string note;           ///< the operator's, for the first page
  std::string operator_name;  ///< name of who ground the tool
  std::string serial;         ///< of the tool
  std::string tolerances;     ///< YAML of what the tool is passed by; empty for the package's own
  int job = 0;                ///< which of a bag's jobs, from 1; 0 for the last
};

/// Writes a report: works out what it says, and has a Python program draw it, if it is to be drawn.
/// @param node the grinder's name, as for historyFolder().
/// @throw JobFileError if the tolerances cannot be read, FileError if the file cannot, there is no record, or the
/// program is missing, std::invalid_argument if nothing is asked for.
/// @return the exit status.
int writeReport(const std::string& node, const ReportOptions& options);

/// Draws a tool into an SVG file. @param json what `grind simulate --json` prints. @return the exit status; the reason
/// is on stderr. @throw FileError if the program is missing.
int drawTool(const std::string& json, OutputFile& svg);

}  // namespace grinder
