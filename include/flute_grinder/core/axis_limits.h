#pragma once

#include "flute_grinder/core/axes.h"

namespace flute_grinder {

/// Bounds for the machine's parameters, in SI units; far beyond any real machine.
constexpr double kSmallestFigure = 1e-9, kLargestFigure = 1e9;

/// The limits of all axes.
struct AxisLimits {
  Axes min_position = Axes::Zero();      ///< [m], A [rad]
  Axes max_position = Axes::Zero();      ///< [m], A [rad]
  Axes max_velocity = Axes::Zero();      ///< [m/s], A [rad/s]
  Axes max_acceleration = Axes::Zero();  ///< [m/s^2], A [rad/s^2]
  Axes max_jerk = Axes::Zero();          ///< [m/s^3], A [rad/s^3]
};

/// The machine data needed to plan a job.
struct Machine {
  AxisLimits limits;
  double period = 0;                ///< control cycle T [s]
  Axes park = Axes::Zero();         ///< position at the end of a job, clear of the workpiece [m], A [rad]
  double max_job_duration = 86400;  ///< longest job accepted [s]
};

}  // namespace flute_grinder
