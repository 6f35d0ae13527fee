#pragma once

#include "cli/output_file.h"
#include "flute_grinder/messages/json.h"

#include <string>

namespace grinder {

/// Arguments of `grind report`.
struct ReportOptions {
  std::string file;           ///< a bag, or a record of the grinder
  bool last = false;          ///< the newest record of the grinder instead
  std::string folder;         ///< folder of the records; empty for the grinder's default folder
  std::string html;           ///< file to write; empty for none
  std::string pdf;            ///< file to write; empty for none
  bool json = false;          ///< print the data as JSON
  std::string note;           ///< operator's note for the first page
  std::string operator_name;  ///< name of the operator who ground the tool
  std::string serial;         ///< serial number of the tool
  std::string tolerances;     ///< YAML of the tolerances; empty for the package's own
  int job = 0;                ///< number of a bag's job, from 1; 0 for the last
};

/// Writes a report: computes its contents, and has a Python program draw it if a file is asked for.
/// @param node name of the grinder, see historyFolder().
/// @throw FileError if the tolerances cannot be read, if the file cannot be read, there is no record, or
/// the program is missing, std::invalid_argument if no output is asked for.
/// @return the exit status.
int writeReport(const std::string& node, const ReportOptions& options);

/// Draws a document into an SVG file. @param program a Python program beside that of the report: tool.py for the output
/// of `grind simulate --json`, measured.py for that of `grind history --figure --json`. @return the exit status, with
/// the reason on stderr. @throw FileError if the program is missing.
int drawPicture(const char* program, const Json& document, OutputFile& svg);

}  // namespace grinder
