#include "node/robot_status.h"

#ifdef HAS_INDUSTRIAL_MSGS
#include <industrial_msgs/RobotStatus.h>
#endif

namespace grinder {

#ifdef HAS_INDUSTRIAL_MSGS

namespace {

industrial_msgs::TriState triState(bool value) {
  industrial_msgs::TriState state;
  state.val = value ? industrial_msgs::TriState::TRUE : industrial_msgs::TriState::FALSE;
  return state;
}

}  // namespace

RobotStatus::RobotStatus(ros::NodeHandle nh)
    : publisher_(nh.advertise<industrial_msgs::RobotStatus>("robot_status", 10)) {}

void RobotStatus::publish(const CycleSample& sample) {
  industrial_msgs::RobotStatus status;
  status.header.stamp = ros::Time(sample.time);
  status.mode.val = industrial_msgs::RobotMode::AUTO;
  status.e_stopped = triState(sample.drive.emergency_stop);
  status.drives_powered = triState(sample.drive.enabled);
  status.motion_possible = triState(isPowered(sample.state) && sample.drive.homed);
  status.in_motion = triState(rowOf(sample.state).moves);
  status.in_error = triState(sample.state == MachineState::kFault);
  publisher_.publish(status);
}

#else

RobotStatus::RobotStatus(ros::NodeHandle) {}
void RobotStatus::publish(const CycleSample&) {}

#endif

}  // namespace grinder
