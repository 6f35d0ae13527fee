#pragma once

#include "control/fixtures.h"
#include "drive/simulated_drive.h"

#include <array>

namespace grinder::test_support {

using Fault = SimulatedDrive::Fault;

/// Uses a drive through its handles alone, as the control loop does.
class Bench {
 public:
  explicit Bench(const SimulatedDrive::Model& model = driveModel(), double period = 0.001,
                 const SimulatedDrive::Equipment& equipment = {})
      : period_(period) {
    drive.init(model, equipment);
    auto* joints = drive.get<PositionJointInterface>();
    for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i] = joints->getHandle(kJointNames[i]);
    drive_ = drive.get<DriveInterface>()->getHandle("drive");
  }

  void command(int axis, double position) { joints_[static_cast<std::size_t>(axis)].setCommand(position); }
  void set(const DriveCommand& command) { drive_.setCommand(command); }
  void set(bool enable, bool reset = false) { set(DriveCommand{enable, reset}); }
  void read() { drive.read(ros::Time(1), ros::Duration(period_)); }
  void write() { drive.write(ros::Time(1), ros::Duration(period_)); }

  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      write();
      read();
    }
  }

  double position(int axis) const { return joints_[static_cast<std::size_t>(axis)].getPosition(); }
  double velocity(int axis) const { return joints_[static_cast<std::size_t>(axis)].getVelocity(); }
  Axes positions() const { return {position(kX), position(kY), position(kZ), position(kA)}; }
  const DriveStatus& status() const { return drive_.getStatus(); }

  SimulatedDrive drive;

 private:
  double period_;
  std::array<JointHandle, kAxisCount> joints_;
  DriveHandle drive_;
};

/// All axes at zero, with the same lag and a fine encoder.
inline SimulatedDrive::Model plainModel(double time_constant = 0.002, double counts_per_unit = 1e12) {
  SimulatedDrive::Model model;
  for (auto& axis : model) axis = {time_constant, counts_per_unit};
  return model;
}

/// Under power, every axis on its way to a position of its own.
class MovingBench : public Bench {
 public:
  MovingBench() : Bench(plainModel()) {
    set(true);
    for (int axis = 0; axis < kAxisCount; ++axis) command(axis, 0.01 * (axis + 1));
    run(3);
  }
};

}  // namespace grinder::test_support
