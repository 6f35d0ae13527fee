#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/machine/machine_geometry.h"
#include "flute_grinder/motion/axis_limits.h"

#include <string>

namespace grinder {

/// Speeds and distances of a probing cycle.
struct ProbingConfig {
  Axes velocity = Axes::Zero();    ///< speed of the first touch [m/s], A [rad/s]
  double slow = 0;                 ///< speed of the measuring touches, as a fraction of `velocity`
  Axes back_off = Axes::Zero();    ///< retreat from the surface between touches [m], A [rad]
  Axes max_spread = Axes::Zero();  ///< maximum spread of the measuring touches [m], A [rad]
  int touches = 0;                 ///< number of measuring touches
};

/// The machine, and the control loop's limits and timeouts.
struct LoopConfig {
  std::string name;  ///< name of the robot description
  Machine machine;
  MachineGeometry geometry;
  Axes following_error = Axes::Zero();  ///< maximum |command - position| [m], A [rad]
  double feedback_timeout = 0;          ///< longest allowed time without fresh positions [s]
  double enable_timeout = 0;            ///< longest allowed time from the enable command to power [s]
  double homing_timeout = 0;            ///< longest allowed time for homing [s]
  double spindle_timeout = 0;           ///< longest allowed time until spindle and coolant are ready for a job [s]
  double jog_timeout = 0;               ///< longest allowed time between the messages of a continuous jog [s]
  Axes jog_velocity = Axes::Zero();     ///< speed of a jog that names none [m/s], A [rad/s]
  ProbingConfig probing;
  double late_slow_down = 2;  ///< cycle length from which the axes are slowed down, then accelerated again [periods]
  double late_fault = 10;     ///< cycle length that is a fault, unless the drive had buffered commands [periods]
};

}  // namespace grinder
