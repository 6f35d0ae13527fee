#pragma once

#include "flute_grinder/core/axes.h"

namespace flute_grinder {

/// Bounds of the parameters of a machine, in SI units; far beyond any real machine.
constexpr double kSmallestFigure = 1e-9, kLargestFigure = 1e9;

/// The limits of every axis.
struct AxisLimits {
  Axes min_position = Axes::Zero();      ///< [m], A [rad]
  Axes max_position = Axes::Zero();      ///< [m], A [rad]
  Axes max_velocity = Axes::Zero();      ///< [m/s], A [rad/s]
  Axes max_acceleration = Axes::Zero();  ///< [m/s^2], A [rad/s^2]
  Axes max_jerk = Axes::Zero();          ///< [m/s^3], A [rad/s^3]
};

/// What planning a job needs to know about the machine.
struct Machine {
  AxisLimits limits;
  double period = 0;                ///< control cycle T [s]
  Axes park = Axes::Zero();         ///< position at the end of a job, clear of the work [m], A [rad]
  double max_job_duration = 86400;  ///< longest job accepted [s]
};

}  // namespace flute_grinder
