#include "flute_grinder/drive/simulated_drive.h"

#include "flute_grinder/drive/machine_config.h"

#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flute_grinder {

namespace {

constexpr std::array<const char*, 6> kFaultNames{"none",           "emergency_stop", "stuck_axis",
                                                 "stale_feedback", "nan_feedback",   "drive_fault"};

template <std::size_t N>
int indexOf(const std::array<const char*, N>& names, const std::string& name) {
  const auto it = std::find(names.begin(), names.end(), name);
  return it == names.end() ? -1 : static_cast<int>(it - names.begin());
}

template <std::size_t N>
std::string list(const std::array<const char*, N>& names) {
  std::string text;
  for (const char* name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

}  // namespace

bool SimulatedDrive::init(ros::NodeHandle&, ros::NodeHandle& robot_hw_nh) {
  XmlRpc::XmlRpcValue parameters;
  robot_hw_nh.getParam("", parameters);
  const ParameterReader p(parameters, robot_hw_nh.getNamespace());
  Model model;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const std::string joint = std::string(kJointNames[i]) + "/";
    model[i].time_constant = p.number(joint + "time_constant", 0, 10);
    model[i].counts_per_unit = p.number(joint + "counts_per_unit", 1, 1e12);
    model[i].start_position = p.number(joint + "start_position", -1e6, 1e6);
  }
  init(model);
  inject_service_ = robot_hw_nh.advertiseService("inject_fault", &SimulatedDrive::onInjectFault, this);
  return true;
}

void SimulatedDrive::init(const Model& model) {
  model_ = model;
  status_.homed = true;
  for (std::size_t i = 0; i < model.size(); ++i) {
    motor_[static_cast<int>(i)] = position_[i] = command_[i] = sent_[i] = model[i].start_position;
    const JointStateHandle state(kJointNames[i], &position_[i], &velocity_[i], &effort_[i]);
    joint_states_.registerHandle(state);
    joint_commands_.registerHandle(JointHandle(state, &command_[i]));
  }
  drive_.registerHandle(DriveHandle("drive", &status_, &drive_command_));
  registerInterface(&joint_states_);
  registerInterface(&joint_commands_);
  registerInterface(&drive_);
}

void SimulatedDrive::read(const ros::Time&, const ros::Duration& period) {
  const std::uint16_t injected = injected_;
  const auto fault = static_cast<Fault>(injected & 0xff);
  const int failing_axis = injected >> 8;
  const double dt = period.toSec();

  status_.emergency_stop = fault == Fault::kEmergencyStop;
  if (fault == Fault::kDriveFault) {
    status_.fault = true;
  } else if (drive_command_.reset) {
    status_.fault = false;
  }
  status_.enabled = drive_command_.enable && !status_.emergency_stop && !status_.fault;
  for (int i = 0; i < kAxisCount; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double last = motor_[i];
    if (status_.enabled && !(fault == Fault::kStuckAxis && i == failing_axis)) {
      motor_[i] += (sent_[n] - last) * dt / (model_[n].time_constant + dt);
    }
    if (fault == Fault::kStaleFeedback) continue;
    velocity_[n] = dt > 0 ? (motor_[i] - last) / dt : 0;
    position_[n] = std::round(motor_[i] * model_[n].counts_per_unit) / model_[n].counts_per_unit;
    if (fault == Fault::kNanFeedback && i == failing_axis) position_[n] = std::numeric_limits<double>::quiet_NaN();
  }
  if (fault != Fault::kStaleFeedback) ++status_.feedback_count;
}

void SimulatedDrive::write(const ros::Time&, const ros::Duration&) { sent_ = command_; }

void SimulatedDrive::inject(Fault fault, int axis) {
  injected_ = static_cast<std::uint16_t>(static_cast<unsigned>(fault) | static_cast<unsigned>(axis) << 8);
}

bool SimulatedDrive::onInjectFault(InjectFault::Request& request, InjectFault::Response& response) {
  const int fault = indexOf(kFaultNames, request.fault);
  const bool needs_joint = request.fault == "stuck_axis" || request.fault == "nan_feedback";
  const int axis = needs_joint ? indexOf(kJointNames, request.joint) : kX;
  response.success = fault >= 0 && axis >= 0;
  if (fault < 0) {
    response.message = "fault = " + request.fault + "; allowed: " + list(kFaultNames);
  } else if (axis < 0) {
    response.message = "joint = " + request.joint + "; allowed: " + list(kJointNames);
  } else {
    inject(static_cast<Fault>(fault), axis);
  }
  return true;
}

}  // namespace flute_grinder

PLUGINLIB_EXPORT_CLASS(flute_grinder::SimulatedDrive, flute_grinder::RobotHW)
