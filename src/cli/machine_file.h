#pragma once

#include "flute_grinder/control/loop_config.h"

#include <string>

namespace grinder {

/// Reads the machine from the files that roslaunch loads, without ROS running.
/// @param parameters YAML, the node's parameters.
/// @param urdf the robot description.
/// @throw JobFileError if a file cannot be read; ParameterError if the machine cannot be used.
LoopConfig readMachineFiles(const std::string& parameters, const std::string& urdf);

/// The text of a robot description. @throw JobFileError if it cannot be read or is no XML.
std::string readUrdfFile(const std::string& path);

/// A file of this package, as `config/grinder.yaml`. @throw JobFileError if the shell does not know the package.
std::string packageFile(const std::string& path);

}  // namespace grinder
