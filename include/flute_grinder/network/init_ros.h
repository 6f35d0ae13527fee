#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace grinder {

/// ros::init() without a disk: by itself it makes the folder `~/.ros/log`, in which roscpp writes nothing, and throws
/// where that cannot be made.
/// @param name of the node. @param options as of ros::init().
/// @return the arguments without ROS's own, with a null pointer at the end, as main() gets them.
/// @throw std::invalid_argument if no ROS master is named, or not as roscpp reads it; ros::Exception if the command
/// line or the environment has an invalid name.
std::vector<char*> initRos(int argc, char** argv, const std::string& name, std::uint32_t options);

}  // namespace grinder
