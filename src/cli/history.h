#pragma once

#include "flute_grinder/record/measured.h"

#include <string>
#include <vector>

namespace grinder {

/// Arguments of `grind history`.
struct HistoryOptions {
  std::vector<std::string> folders;  ///< one for each grinder; empty for the default folder of the grinder
  bool judge_again = false;          ///< judge the records again first, and keep the new verdicts
  std::string tolerances;            ///< YAML of the tolerances for that; empty for the package's own
  // Filters of the records to list; empty for all.
  std::string tool;          ///< part of the job's name or of the tool's description, in any case
  std::string grinder;       ///< a part of the path of the grinder's folder
  std::string since, until;  ///< dates for timeOfDate()
  std::string verdict;       ///< name of a Verdict
  bool json = false;
  std::string csv;  ///< a file to write; empty for none
};

/// The folder in which a grinder keeps the records of its jobs by default, on the computer and for the user that run
/// its node. @param node the grinder's name, as for --node; ros::init() must have been called.
/// @throw std::runtime_error if there is no home directory.
std::string historyFolder(const std::string& node);

/// The path of the newest record in a folder. @param folder empty for the default folder. @param node see
/// historyFolder().
/// @throw FileError if there is none.
std::string lastRecord(const std::string& node, const std::string& folder);

/// The tools of a job's operation in a grinder's folder. @param folder empty for the default folder. @param node see
/// historyFolder(). @throw FileError if the folder cannot be read.
std::vector<ToolNumber> toolsOf(const std::string& node, const std::string& folder, const GrindJob& job);

/// The operations of a job file that the records show as done, as text for people. An operation counts only if neither
/// it nor an earlier one has changed since. @param node see historyFolder(). @return empty for a file that cannot be
/// read or has a single operation.
std::string doneOperations(const std::string& node, const std::string& job);

/// The path of the file of tolerances. @param path empty for the package's own file.
std::string tolerancesFile(const std::string& path);

/// Lists the records of one or many grinders with the verdict on each, the newest last. Folders and records that cannot
/// be read are named, and the rest is listed. @param node see historyFolder().
/// @return the exit status: 2 if a folder or a record could not be read, or a new verdict could not be kept.
/// @throw std::invalid_argument if no record can match, FileError if the tolerances cannot be read or the
/// CSV file cannot be written.
int printHistory(const std::string& node, const HistoryOptions& options);

}  // namespace grinder
