#pragma once

#include "flute_grinder/record/machine_info.h"

#include <ros/ros.h>

namespace flute_grinder {

/// Publishes it on `~machine`, latched for as long as the publisher is kept.
ros::Publisher publishMachine(ros::NodeHandle private_nh, const core::MachineInfo& info);

}  // namespace flute_grinder
