#pragma once

#include "flute_grinder/core/axes.h"

namespace flute_grinder {

/// Bounds of the figures of a machine, in SI units; far beyond every machine.
constexpr double kSmallestFigure = 1e-9, kLargestFigure = 1e9;

/// What every axis may do.
struct AxisLimits {
  Axes min_position = Axes::Zero();      ///< [m], A [rad]
  Axes max_position = Axes::Zero();      ///< [m], A [rad]
  Axes max_velocity = Axes::Zero();      ///< [m/s], A [rad/s]
  Axes max_acceleration = Axes::Zero();  ///< [m/s^2], A [rad/s^2]
  Axes max_jerk = Axes::Zero();          ///< [m/s^3], A [rad/s^3]
};

/// What a job must know of the machine that is to run it.
struct Machine {
  AxisLimits limits;
  double period = 0;                ///< control cycle T [s]
  Axes park = Axes::Zero();         ///< where a job ends, clear of the work [m], A [rad]
  double max_job_duration = 86400;  ///< longest job that is planned [s]
};

}  // namespace flute_grinder
