#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/messages/json.h"

#include <string>

namespace grinder {

struct LoopConfig;

/// Identity and limits of the machine, for `~machine` and for the records of jobs.
struct MachineInfo {
  std::string name;                         ///< name of the robot description
  std::string version;                      ///< version of flute_grinder
  std::string drive;                        ///< type of the drive's plugin
  double period = 0;                        ///< control cycle [s]
  Axes max_velocity = Axes::Zero();         ///< limits [m/s], A [rad/s]
  Axes max_acceleration = Axes::Zero();     ///< limits [m/s^2], A [rad/s^2]
  Axes max_following_error = Axes::Zero();  ///< limits [m], A [rad]
};

/// @param drive type of the drive's plugin.
MachineInfo machineInfo(const LoopConfig& config, const std::string& drive);

/// The machine as written in records, see docs/ros-interface.md.
Json toJson(const MachineInfo& machine);

}  // namespace grinder
