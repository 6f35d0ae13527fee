#pragma once

#include "flute_grinder/InjectFault.h"
#include "flute_grinder/core/axes.h"
#include "flute_grinder/drive/robot_hw.h"

#include <atomic>

namespace flute_grinder {

/// Servo axes in software: each follows its command with a first-order lag and is read through an encoder. Tests
/// make it fail through the service ~hardware/inject_fault.
///
/// Parameters for each joint, in the drive's namespace: `<joint>/time_constant` [s], `<joint>/counts_per_unit` [1/m or
/// 1/rad], `<joint>/start_position` [m or rad].
class SimulatedDrive : public RobotHW {
 public:
  /// How one axis behaves.
  struct AxisModel {
    double time_constant = 0;    ///< [s]
    double counts_per_unit = 1;  ///< of the encoder [1/m or 1/rad]
    double start_position = 0;   ///< [m or rad]
  };
  using Model = std::array<AxisModel, kAxisCount>;

  enum class Fault : std::uint8_t { kNone, kEmergencyStop, kStuckAxis, kStaleFeedback, kNanFeedback, kDriveFault };

  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;
  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;

  /// Sets the drive up without ROS.
  void init(const Model& model);

  /// Makes the drive fail from the next read() on, or takes all faults back (kNone); a drive fault stays until it is
  /// reset. Thread safe.
  /// @param axis of kStuckAxis and kNanFeedback.
  void inject(Fault fault, int axis = kX);

 private:
  bool onInjectFault(InjectFault::Request& request, InjectFault::Response& response);

  Model model_;
  std::atomic<std::uint16_t> injected_{0};  ///< fault and axis in one word
  ros::ServiceServer inject_service_;

  Axes motor_ = Axes::Zero();  ///< where the axes really are
  std::array<double, kAxisCount> position_{}, velocity_{}, effort_{}, command_{};
  std::array<double, kAxisCount> sent_{};  ///< commands as of the last write()
  DriveStatus status_;
  DriveCommand drive_command_;

  JointStateInterface joint_states_;
  PositionJointInterface joint_commands_;
  DriveInterface drive_;
};

}  // namespace flute_grinder
