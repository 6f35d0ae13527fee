#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/conical_cutter.h"

namespace grinder {

/// Bounds for the machine's parameters, in SI units; far beyond any real machine.
constexpr double kMinFigure = 1e-9, kMaxFigure = 1e9;

/// The limits of all axes; positions in machine coordinates.
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
  Axes park = Axes::Zero();         ///< machine position at a job's end, clear of the work [m], A [rad]
  double max_job_duration = 86400;  ///< maximum duration of a job [s]
  double collision_clearance = 0;   ///< minimum distance of the wheel and its carriers from other parts [m]
  Range swivel{-units::kPi / 2, units::kPi / 2};  ///< range to which the wheel's plane can be swivelled [rad]
};

}  // namespace grinder
