#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/base/await.h"
#include "flute_grinder/client/latest.h"

#include <ros/ros.h>

#include <chrono>

namespace grinder {

/// Whether a job controls the machine.
bool inJob(const flute_grinder::GrinderState& state);

/// Waits for a condition. @return whether it came true in time.
template <typename Condition>
bool await(const ros::WallDuration& timeout, Condition condition) {
  bool is_true = false;
  await(std::chrono::nanoseconds(timeout.toNSec()), std::chrono::milliseconds(5), [&] {
    is_true = condition();
    return is_true || !ros::ok();
  });
  return is_true;
}

const ros::WallDuration kPatience(10);       ///< longest wait for a node that is still starting
const ros::WallDuration kMasterPatience(2);  ///< longest wait for a ROS master that does not answer

/// The grinder's states, 20 times a second, and 10 times while the machine is at rest.
using States = Latest<flute_grinder::GrinderState>;

/// Waits for a state sent after this call. @return false if the connection is lost.
bool awaitNext(const States& states);
/// Whether nothing has been received for too long.
bool isLost(const States& states);

/// Error text for a lost connection.
extern const char* const kLinkLost;

}  // namespace grinder
