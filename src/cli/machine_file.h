#pragma once

#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/machine/machine_model.h"

#include <string>

namespace grinder {

struct MachineFiles {
  MachineModel model;
  LoopConfig config;
};

/// Reads the machine from the files that roslaunch loads, without ROS running.
/// @param parameters YAML, the node's parameters.
/// @param urdf the robot description.
/// @throw JobFileError if a file cannot be read; ParameterError or std::invalid_argument if the machine cannot
///        be used.
MachineFiles readMachineFiles(const std::string& parameters, const std::string& urdf);

/// A file of this package, as `config/grinder.yaml`. @throw JobFileError if the shell does not know the package.
std::string packageFile(const std::string& path);

}  // namespace grinder
