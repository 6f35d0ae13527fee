#pragma once

#include "control/fixtures.h"
#include "drive/simulated_drive.h"

namespace grinder::test_support {

using Fault = SimulatedDrive::Fault;

/// Uses a drive as the control loop does.
class Bench {
 public:
  explicit Bench(const SimulatedDrive::Model& model = driveModel(), double period = 0.001,
                 const SimulatedDrive::Equipment& equipment = {})
      : cycle_{ros::Time(1), ros::Duration(period), ros::Duration(period)} {
    drive.init(model, equipment);
    read();
    asked.position = feedback_.position;
  }

  void command(int axis, double position) { asked.position[static_cast<std::size_t>(axis)] = position; }
  void read() { drive.read(cycle_, feedback_); }

  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      drive.write(cycle_, asked);
      read();
    }
  }

  double position(int axis) const { return feedback_.position[static_cast<std::size_t>(axis)]; }
  double velocity(int axis) const { return feedback_.velocity[static_cast<std::size_t>(axis)]; }
  Axes positions() const { return {position(kX), position(kY), position(kZ), position(kA)}; }
  const DriveStatus& status() const { return feedback_.status; }

  SimulatedDrive drive;
  DriveCommand asked;  ///< in every cycle

 private:
  DriveCycle cycle_;
  DriveFeedback feedback_;
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
    asked.enable = true;
    for (int axis = 0; axis < kAxisCount; ++axis) command(axis, 0.01 * (axis + 1));
    run(3);
  }
};

}  // namespace grinder::test_support
