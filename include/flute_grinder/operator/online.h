#pragma once

#include <string>

namespace flute_grinder {

/// Arguments of `grind run`.
struct RunOptions {
  std::string node;  ///< name of the grinder's node
  std::string job;
  bool dry_run = false;
  bool go_on = false;  ///< from the first pass that is not finished
  std::string csv;     ///< file for the setpoints that were streamed, or empty
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

/// Homes the axes, and waits until that is over. @return the exit status.
int home(const std::string& node);

/// Sets the feed override. @param percent 0 to 120. @return the exit status.
int setFeedOverride(const std::string& node, double percent);

}  // namespace flute_grinder
