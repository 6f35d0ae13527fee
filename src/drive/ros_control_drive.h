#pragma once

#include "drive/mode_switch.h"
#include "drive/remote_signals.h"
#include "drive/ros_control_parameters.h"
#include "flute_grinder/drive/drive.h"

#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/ros.h>
#include <pluginlib/class_loader.hpp>

#include <array>
#include <atomic>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace grinder {

/// Hardware that ros_control drives: any class derived from hardware_interface::RobotHW, unchanged, with a joint for
/// each axis that takes positions, or positions and velocities. Signals that a RobotHW lacks, such as the emergency
/// stop, are constants in the parameters, or are exchanged with other programs; docs/ros-control.md lists them.
class RosControlDrive : public Drive {
 public:
  void init(ros::NodeHandle& node_nh, ros::NodeHandle& drive_nh) override;
  DriveCapabilities capabilities() const override;
  void prepare() override;
  void read(const DriveCycle& cycle, DriveFeedback& feedback) override;
  void write(const DriveCycle& cycle, const DriveCommand& command) override;
  /// Waits by the monotonic clock; returns at once if the RobotHW's read() blocks and so is the clock.
  ros::Duration wait(const ros::Duration& nominal) override;
  bool powerOff() override;

 private:
  friend ModeSwitch;

  struct Joint {
    hardware_interface::JointStateHandle state;
    hardware_interface::JointHandle position;  ///< used if there is no `with_velocity`
    std::optional<hardware_interface::PosVelJointHandle> with_velocity;
    void command(double position, double velocity);
    double commanded() const;
  };
  struct Signals {
    std::optional<SignalInput> emergency_stop, homed, spindle_at_speed, coolant_on, enabled, fault, probe_free,
        probe_contact;
  };
  struct Commands {
    std::optional<SwitchOutput> power, spindle, coolant;
    std::optional<TriggerOutput> home, reset;
  };

  void doSwitch(bool on);
  ModeSwitch::Result switchResult() const;
  void loadRobotHw(const std::string& type, ros::NodeHandle& drive_nh);
  void takeJoints(const std::array<std::string, kAxisCount>& names);
  void connect(const RosControlParameters& parameters);
  void listen(std::optional<SignalInput>& input, const std::string& source, bool safe, double timeout);
  void readStatus(DriveStatus& status);
  void readFault(DriveStatus& status);
  void passOn(const DriveCommand& command);
  void prepareStop();
  void commandJoints(const DriveCycle& cycle, const DriveCommand& last, bool moves);

  // The class loader must outlive the objects that it has loaded.
  std::unique_ptr<pluginlib::ClassLoader<hardware_interface::RobotHW>> loader_;
  pluginlib::UniquePtr<hardware_interface::RobotHW> robot_hw_;
  std::array<Joint, kAxisCount> joints_;
  std::list<hardware_interface::ControllerInfo> controller_;  ///< the grinder, as a controller
  const std::list<hardware_interface::ControllerInfo> none_;

  ros::NodeHandle nh_;
  Signals signals_;
  std::list<ros::Subscriber> subscribers_;  ///< their callbacks use the signals
  Commands commands_;
  bool read_is_clock_ = false;

  ModeSwitch mode_;
  std::mutex prepare_mutex_;           ///< guards calls of prepareSwitch(), never taken in the control thread
  std::atomic<bool> prepared_{false};  ///< a switch to the grinder's commands was prepared, and no stop since
  std::optional<TriggerOutput> stop_;
  bool used_ = false;          ///< power was commanded since the last stop
  int unused_ = 0;             ///< cycles since a preparation without a command for power
  bool stopping_ = false;      ///< a stop is being prepared
  bool homing_seen_ = false;   ///< homing was commanded in the previous cycle
  bool read_returned_ = true;  ///< the last read() returned and did not throw
  int fast_ = 0;               ///< cycles in a row that came too soon; once too many, kept until a reset
  DriveCommand sent_;
  int changed_axis_ = kAxisCount;       ///< axis whose command the RobotHW has changed; kAxisCount for none
  std::atomic<bool> power_off_{false};  ///< powerOff() was called, and `enable` has not been false since
};

}  // namespace grinder
