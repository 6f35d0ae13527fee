#pragma once

#include "flute_grinder/InjectFault.h"
#include "flute_grinder/core/axes.h"
#include "flute_grinder/drive/robot_hw.h"

#include <atomic>

namespace flute_grinder {

/// A tool grinder in software. Each axis follows its command with a first-order lag and is read through an encoder; an
/// incremental one reads 0 where the axis stands at the start, until it is homed. Homing takes the axes to their home
/// positions, one after the other: Y, X, Z, A; the spindle runs up in a given time; coolant flows at once. Tests make
/// it fail through the service ~hardware/inject_fault.
///
/// Parameters, in the drive's namespace: for each joint `<joint>/time_constant` [s], `<joint>/counts_per_unit` [1/m or
/// 1/rad], `<joint>/start_position` and `<joint>/home_position` [m or rad], `<joint>/homing_velocity` [m/s or rad/s];
/// `absolute_encoders`, `spindle_run_up_time` [s].
class SimulatedDrive : public RobotHW {
 public:
  /// How one axis behaves.
  struct AxisModel {
    double time_constant = 0;    ///< [s]
    double counts_per_unit = 1;  ///< of the encoder [1/m or 1/rad]
    double start_position = 0;   ///< [m or rad]
    double home_position = 0;    ///< [m or rad]
    double homing_velocity = 1;  ///< [m/s or rad/s]
  };
  using Model = std::array<AxisModel, kAxisCount>;

  /// How the rest behaves.
  struct Equipment {
    bool absolute_encoders = true;   ///< homed from the start
    double spindle_run_up_time = 0;  ///< [s]
  };

  enum class Fault : std::uint8_t {
    kNone,
    kEmergencyStop,
    kStuckAxis,
    kStaleFeedback,
    kNanFeedback,
    kDriveFault,
    kReferenceLost,
    kSpindleLost,
    kCoolantLost
  };

  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;
  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;

  /// Sets the drive up without ROS.
  void init(const Model& model, const Equipment& equipment);

  /// Makes the drive fail from the next read() on, or takes all faults back (kNone); a drive fault stays until it is
  /// reset. Thread safe.
  /// @param axis of kStuckAxis and kNanFeedback.
  void inject(Fault fault, int axis = kX);

 private:
  void readSwitches(Fault fault);
  void readEquipment(Fault fault, double dt);
  void moveMotors(Fault fault, int failing_axis, double dt);
  void home(double dt);
  bool onInjectFault(InjectFault::Request& request, InjectFault::Response& response);

  Model model_;
  Equipment equipment_;
  std::atomic<std::uint16_t> injected_{0};  ///< fault and axis in one word
  ros::ServiceServer inject_service_;

  Axes motor_ = Axes::Zero();   ///< where the axes really are
  Axes offset_ = Axes::Zero();  ///< of what the encoders read
  bool home_was_commanded_ = false;
  double spindle_speed_ = 0;  ///< of the full one
  std::array<double, kAxisCount> position_{}, velocity_{}, effort_{}, command_{};
  std::array<double, kAxisCount> sent_{};  ///< commands as of the last write()
  DriveStatus status_;
  DriveCommand drive_command_;

  JointStateInterface joint_states_;
  PositionJointInterface joint_commands_;
  DriveInterface drive_;
};

}  // namespace flute_grinder
