#pragma once

#include "flute_grinder/job/axes.h"
#include "flute_grinder/messages/json.h"

#include <string>

namespace grinder {

struct LoopConfig;

/// Identity and limits of the machine, as `~machine` publishes them and the records of jobs have them.
struct MachineInfo {
  std::string name;                         ///< of the robot description
  std::string version;                      ///< of flute_grinder
  std::string drive;                        ///< type of the drive's plugin
  double period = 0;                        ///< control cycle [s]
  Axes max_velocity = Axes::Zero();         ///< [m/s], A [rad/s]
  Axes max_acceleration = Axes::Zero();     ///< [m/s^2], A [rad/s^2]
  Axes max_following_error = Axes::Zero();  ///< [m], A [rad]
};

/// @param drive type of the drive's plugin.
MachineInfo machineInfo(const LoopConfig& config, const std::string& drive);

/// As records have it, see docs/ros-interface.md.
Json toJson(const MachineInfo& machine);

}  // namespace grinder
