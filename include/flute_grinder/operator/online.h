#pragma once

#include <string>

namespace flute_grinder {

/// Arguments of `grind run`.
struct RunOptions {
  std::string node;  ///< name of the grinder's node
  std::string job;
  bool dry_run = false;
  std::string csv;  ///< file for the setpoints that were streamed, or empty
};

/// Waits for the ROS master, which may be only just coming up. @return whether it answers.
bool awaitMaster();

/// Sends a job to the grinder and follows it to its end; Ctrl-C cancels it and waits for the stop. @return the exit
/// status.
int runJob(const RunOptions& options);

/// Prints what the grinder is doing. @return the exit status.
int printStatus(const std::string& node);

/// Calls one of the grinder's services without arguments. @return the exit status.
int callTrigger(const std::string& node, const std::string& service);

}  // namespace flute_grinder
