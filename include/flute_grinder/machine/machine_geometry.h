#pragma once

#include <Eigen/Core>

#include <optional>

namespace grinder {

struct GrindJob;
struct GrindProcess;

/// The ball of a measuring probe that the wheel head carries.
struct ProbeBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of the ball when the probe is swung in [m]
  double diameter = 0;                               ///< [m]
};

/// The positions of a machine's parts in machine coordinates: X toward the work head, Y from the work to the wheel, Z
/// up, in the direction in which the axes move the wheel relative to the cutter. Parts that the axes move are given
/// with all axes at zero.
struct MachineGeometry {
  double work_axis_y = 0;  ///< Y of the work spindle's axis [m]
  double work_axis_z = 0;  ///< Z of the work spindle's axis [m]
  double collet_face = 0;  ///< X of the collet's face [m]
  Eigen::Vector3d swivel_centre =
      Eigen::Vector3d::Zero();  ///< intersection of the swivel's axis with the wheel spindle's axis [m]
  double flange =
      0;  ///< distance from the swivel's centre along the spindle, up at swivel 0, to the wheel's flange face [m]
  std::optional<ProbeBall> probe;
};

/// How wheel and work are mounted.
struct Mounting {
  double flange_to_wheel = 0;  ///< distance from the flange's face down to the wheel's upper face [m]
  double stickout = 0;         ///< distance from the collet's face to the cutter's small end [m]
};

/// The middle of the wheel's width with all axes at zero [m].
Eigen::Vector3d wheelCentre(const MachineGeometry& machine, const GrindProcess& process, double flange_to_wheel);

/// The machine positions of X, Y and Z at which a job's X, Y and Z are zero: the middle of the wheel's width is above
/// the cutter's small end, at the set-up's height above the work spindle's axis, and a wheel of the diameter to which Y
/// is set touches the small end [m].
Eigen::Vector3d workZero(const MachineGeometry& machine, const GrindJob& job, const Mounting& mounting);

}  // namespace grinder
