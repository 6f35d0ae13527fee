#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace grinder {

/// Calls ros::init() without the use of a disk: by itself ros::init() makes the folder `~/.ros/log`, which roscpp does
/// not use, and throws if it cannot. The program runs by the system clock also where `/use_sim_time` is set: by
/// `/clock`, roscpp's timers, actionlib and diagnostic_updater throw near the end of ros::Time's range.
/// @param name name of the node. @param options see ros::init().
/// @return the arguments without ROS's own, with a null pointer at the end, as main() gets them.
/// @throw std::invalid_argument if no ROS master is named, or roscpp cannot read its name; ros::Exception if the
/// command line or the environment has an invalid name.
std::vector<char*> initRos(int argc, char** argv, const std::string& name, std::uint32_t options);

}  // namespace grinder
