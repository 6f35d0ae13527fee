#pragma once

#include "flute_grinder/core/axes.h"
#include "flute_grinder/core/axis_limits.h"

namespace flute_grinder {

/// The machine, and the control loop's limits and timeouts.
struct LoopConfig {
  Machine machine;
  Axes following_error = Axes::Zero();  ///< largest |command - position| [m], A [rad]
  double feedback_timeout = 0;          ///< longest time without fresh positions [s]
  double enable_timeout = 0;            ///< longest time from the enable command to power [s]
  double homing_timeout = 0;            ///< longest time that homing may take [s]
  double spindle_timeout = 0;           ///< longest time until spindle and coolant are ready for a job [s]
  double late_slow_down =
      2;  ///< period from which on a cycle is late and the axes are brought up to speed again [periods]
  double late_fault = 10;  ///< period from which on the machine stops [periods]
};

}  // namespace flute_grinder
