#pragma once

#include <Eigen/Core>

#include <optional>

namespace grinder {

struct GrindJob;
struct GrindProcess;

/// The ball of a measuring probe that the wheel head carries.
struct ProbeBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< swung in [m]
  double diameter = 0;                               ///< [m]
};

/// Where the parts of a machine stand in machine coordinates: X toward the work head, Y from the work to the wheel, Z
/// up, in the direction in which the axes move the wheel relative to the cutter. What the axes move stands as at their
/// zero.
struct MachineGeometry {
  double work_axis_y = 0;  ///< the work spindle's axis [m]
  double work_axis_z = 0;  ///< the same [m]
  double collet_face = 0;  ///< X of the collet's face [m]
  Eigen::Vector3d swivel_centre =
      Eigen::Vector3d::Zero();  ///< where swivel's axis crosses that of the wheel's spindle [m]
  double flange =
      0;  ///< from the swivel's centre along the spindle, up at swivel 0, to the face that the wheel lies on [m]
  std::optional<ProbeBall> probe;
};

/// How wheel and work are mounted.
struct Mounting {
  double flange_to_wheel = 0;  ///< from the flange's face down to the wheel's upper face [m]
  double stickout = 0;         ///< from the collet's face to the cutter's small end [m]
};

/// Where the middle of the wheel's width stands, the axes at zero. [m]
Eigen::Vector3d wheelCentre(const MachineGeometry& machine, const GrindProcess& process, double flange_to_wheel);

/// The positions of X, Y and Z in machine coordinates at which a job's X, Y and Z are zero: the middle of the wheel's
/// width stands over the cutter's small end, at the height of the set-up above the work spindle's axis, and a wheel of
/// the diameter to which Y is set touches the small end. [m]
Eigen::Vector3d workZero(const MachineGeometry& machine, const GrindJob& job, const Mounting& mounting);

}  // namespace grinder
