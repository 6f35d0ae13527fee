#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/client/latest.h"

#include <ros/ros.h>

namespace grinder {

/// Whether a job controls the machine.
bool inJob(const flute_grinder::GrinderState& state);

/// Waits for a condition. @return whether it came true in time.
template <typename Condition>
bool await(const ros::WallDuration& timeout, Condition condition) {
  const ros::SteadyTime end = ros::SteadyTime::now() + timeout;
  while (ros::ok() && !condition()) {
    if (ros::SteadyTime::now() > end) return false;
    ros::WallDuration(0.005).sleep();
  }
  return condition();
}

const ros::WallDuration kPatience(10);       ///< longest wait for a node that is still starting
const ros::WallDuration kMasterPatience(2);  ///< longest wait for a ROS master that does not answer

/// The grinder's states, 20 times a second, and 10 times while the machine is at rest.
using States = Latest<flute_grinder::GrinderState>;

/// Waits for a state sent after this call. @return false if the connection is lost.
bool awaitNext(const States& states);
/// Whether nothing has been received for 3 s. If so it waits half a second more for what may not have been read.
bool isLost(const States& states);

/// Error text for a lost connection.
extern const char* const kLinkLost;

}  // namespace grinder
