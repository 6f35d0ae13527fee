#pragma once

#include <string>
#include <vector>

namespace grinder {

/// Arguments of `grind history`.
struct HistoryOptions {
  std::vector<std::string> folders;  ///< one for each grinder; empty for the default folder of the grinder
  bool judge_again = false;          ///< before they are listed, and keep the new verdicts
  std::string tolerances;            ///< YAML of what they are judged by again; empty for the package's own
  // Which records are listed; empty for all.
  std::string tool;          ///< part of the job's name or of the tool in words, in upper or lower case
  std::string grinder;       ///< a part of its folder's path
  std::string since, until;  ///< as of timeOfDate()
  std::string verdict;       ///< as Verdict has it
  bool json = false;
  std::string csv;  ///< a file to write; empty for none
};

/// The folder in which a grinder keeps the records of its jobs by default, on the computer and for the user that run
/// its node. @param node the grinder's name, as after --node; ros::init() must have been called.
/// @throw std::runtime_error if there is no home directory.
std::string historyFolder(const std::string& node);

/// The path of the newest record in a folder. @param folder empty for the default one. @param node as for
/// historyFolder().
/// @throw FileError if there is none.
std::string lastRecord(const std::string& node, const std::string& folder);

/// Which operations of a job file the records show as done, with nothing changed of them or what is ahead of them
/// since; for people. @param node as for historyFolder(). @return empty for a file that cannot be read, or has a single
/// one.
std::string doneOperations(const std::string& node, const std::string& job);

/// The file of tolerances that is asked for. @param path empty for the package's own.
std::string tolerancesFile(const std::string& path);

/// Lists the records of one or many grinders with the verdict on each, the newest last. What cannot be read is named,
/// and the rest is listed. @param node as for historyFolder().
/// @return the exit status: 2 if a folder or a record could not be read, or a new verdict not be kept.
/// @throw std::invalid_argument if no record can be meant, JobFileError if the tolerances cannot be read, FileError if
/// the CSV file cannot be written.
int printHistory(const std::string& node, const HistoryOptions& options);

}  // namespace grinder
