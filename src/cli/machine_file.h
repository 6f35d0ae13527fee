#pragma once

#include "flute_grinder/control/machine_config.h"

#include <string>
#include <vector>

namespace grinder {

struct MachineFiles {
  MachineModel model;
  MachineConfig config;
};

/// Reads the machine from the files that roslaunch loads, without ROS running.
/// @param parameters YAML, the node's parameters; each file overrides the files before it.
/// @param urdf the robot description.
/// @throw FileError if a file cannot be read, has a key twice, or a number that roslaunch would read differently;
///        ParameterError or std::invalid_argument if the machine cannot be used.
MachineFiles readMachineFiles(const std::vector<std::string>& parameters, const std::string& urdf);

/// Arguments of `grind machine`.
struct MachineOptions {
  std::vector<std::string> parameters;
  std::string urdf;
  std::string bag;  ///< bag that the launch is going to write; empty for none
};

/// Reads and checks the files, and prints their paths in a line. @return the exit status. @throw FileError if the
/// bag cannot be written, or would replace another.
int runMachine(const MachineOptions& options);

/// The path of a file of this package, e.g. `config/grinder.yaml`. @throw FileError if the shell does not know the
/// package.
std::string packageFile(const std::string& path);

}  // namespace grinder
