#pragma once

#include "flute_grinder/GrinderState.h"

#include <ros/ros.h>

namespace grinder {

/// Publishes the machine's status on `robot_status` as industrial_msgs/RobotStatus, as other drivers do. Does
/// nothing if that package is not installed.
class RobotStatus {
 public:
  /// @param nh the node's namespace.
  explicit RobotStatus(ros::NodeHandle nh);
  void publish(const flute_grinder::GrinderState& state);

 private:
  ros::Publisher publisher_;
};

}  // namespace grinder
