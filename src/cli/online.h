#pragma once

#include "flute_grinder/machine/machine_state.h"

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace grinder {

/// Arguments of `grind run`.
struct RunOptions {
  std::string job;
  std::string operation;  ///< one of several operations; empty for the only one
  bool dry_run = false;
  bool go_on = false;                ///< continues from the first unfinished pass
  std::vector<std::string> answers;  ///< answers given beforehand
  std::string csv;                   ///< file for the streamed setpoints, or empty
};

/// Waits for the ROS master for up to kMasterPatience, and makes this program a node with its own thread for callbacks.
/// @param node name of the grinder's node. @return whether the master answers, and knows the grinder.
bool joinRos(const std::string& node);

/// Leaves ROS. To be called last: waits only for the master, once for each service, and for no thread of roscpp. From
/// then on Ctrl-C ends the program.
void leaveRos();

/// Prints an error. @return the exit status of a failure.
int fail(const std::string& text);

/// Prints that a request was carried out. @return the exit status of a success.
int succeed(const std::string& text);
/// Prints why no grinder can be reached: no master, no clock or no node. @return the exit status of a failure.
int noGrinder(const ros::NodeHandle& nh);

/// Sends a job to the grinder and follows it to its end; Ctrl-C cancels it and waits for the stop, Ctrl-Z holds it.
/// @param node name of the grinder's node. @return the exit status. @throw FileError, before anything is sent, if a
/// file cannot be opened.
int runJob(const std::string& node, const RunOptions& options);

/// Prints the state of the grinder. @param json whether as JSON. @return the exit status.
int printStatus(const std::string& node, bool json);

/// Sends a trigger or a stop to the grinder. Waits for the end of homing, of a lift and of a canceled job.
/// @return the exit status.
int request(const std::string& node, MachineEvent event);

/// Confirms the swivel angle set by hand. @param degrees -90 to 90. @return the exit status.
int confirmSwivel(const std::string& node, double degrees);

/// Moves an axis by hand, waits until it rests, and prints where it stands; Ctrl-C and Ctrl-Z stop it.
/// @param axis kX ... kA.
/// @param distance signed distance [mm], A [deg].
/// @param feed speed [mm/min], A [deg/min]; 0 for the machine's jog_velocity.
/// @return the exit status.
int jog(const std::string& node, int axis, double distance, double feed);

/// Sets the feed override. @param percent 0 to 100 * kMaxFeedOverride. @return the exit status.
int setFeedOverride(const std::string& node, double percent);

}  // namespace grinder
