#pragma once

#include "flute_grinder/control/loop_config.h"

#include <string>

namespace flute_grinder {

/// Reads the machine from the files that roslaunch loads, without ROS running.
/// @param parameters YAML, the node's parameters.
/// @param urdf the robot description.
/// @throw JobFileError if a file cannot be read; ParameterError if the machine cannot be used.
LoopConfig readMachineFiles(const std::string& parameters, const std::string& urdf);

}  // namespace flute_grinder
