#pragma once

#include "flute_grinder/core/machine_state.h"

#include <ros/node_handle.h>

#include <string>

namespace flute_grinder {

/// Arguments of `grind run`.
struct RunOptions {
  std::string node;  ///< name of the grinder's node
  std::string job;
  bool dry_run = false;
  bool go_on = false;    ///< from the first pass that is not finished
  bool discard = false;  ///< although the journal keeps another job that is not finished
  std::string csv;       ///< file for the setpoints that were streamed, or empty
};

/// Waits for the ROS master, which may be only just coming up. @return whether it answers.
bool awaitMaster();

/// Prints why not. @return the exit status for that.
int fail(const std::string& text);
/// Prints what is missing where nothing is heard of a grinder: the master, the clock or the node. @return the exit
/// status for that.
int noGrinder(const ros::NodeHandle& nh);

/// Sends a job to the grinder and follows it to its end; Ctrl-C cancels it and waits for the stop, Ctrl-Z holds it.
/// @return the exit status. @throw FileError, before anything is sent, if a file cannot be opened.
int runJob(const RunOptions& options);

/// Prints what the grinder is doing. @param json in JSON. @return the exit status.
int printStatus(const std::string& node, bool json);

/// Has the grinder carry out a trigger or a stop. Waits for the end of homing, of a lift and of a canceled job.
/// @return the exit status.
int request(const std::string& node, MachineEvent event);

/// Sets the feed override. @param percent 0 to 120. @return the exit status.
int setFeedOverride(const std::string& node, double percent);

}  // namespace flute_grinder
