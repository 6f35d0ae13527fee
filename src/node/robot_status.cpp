#include "node/robot_status.h"

#ifdef HAS_INDUSTRIAL_MSGS
#include "flute_grinder/machine/machine_state.h"

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

void RobotStatus::publish(const flute_grinder::GrinderState& state) {
  const auto machine = static_cast<MachineState>(state.state);
  industrial_msgs::RobotStatus status;
  status.header.stamp = state.header.stamp;
  status.mode.val = industrial_msgs::RobotMode::AUTO;
  status.e_stopped = triState(state.emergency_stop != 0);
  status.drives_powered = triState(state.enabled != 0);
  status.motion_possible = triState(isPowered(machine) && state.homed != 0);
  status.in_motion = triState(rowOf(machine).moves);
  status.in_error = triState(machine == MachineState::kFault);
  publisher_.publish(status);
}

#else

RobotStatus::RobotStatus(ros::NodeHandle) {}
void RobotStatus::publish(const flute_grinder::GrinderState&) {}

#endif

}  // namespace grinder
