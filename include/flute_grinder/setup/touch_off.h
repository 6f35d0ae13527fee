#pragma once

#include "flute_grinder/job/wheel_file.h"
#include "flute_grinder/machine/machine_geometry.h"

#include <optional>
#include <string>

namespace grinder {

struct GrindJob;

/// Readings of the axes when the wheel touches a cylinder of any diameter D. The wheel touches a cone beside its
/// highest line, with its centre lower.
struct TouchReadings {
  double y = 0;        ///< Y less (D - D1) / 2, with the circumference at the height of the cutter's axis [m]
  double z_for_y = 0;  ///< Z at which the largest circumference is at that height [m]
  double z = 0;        ///< Z less D / 2, with the lower face on top of the blank and the swivel at 0 [m]
};

/// @param job job with its set-up.
/// @param above_swivel height of the wheel's middle above the swivel's centre, along the spindle; turning the swivel
///        from 0 to S lowers the wheel by 1 - cos S of it [m].
TouchReadings touchReadings(const GrindJob& job, double above_swivel = 0);

/// Height of the middle of a job's wheel above the swivel's centre, along the spindle; nothing unless there is a
/// wheel file with the wheel's position on the flange [m].
/// @param machine only its flange is used.
std::optional<double> wheelAboveSwivel(const std::optional<WheelFile>& wheel, const GrindJob& job,
                                       const MachineGeometry& machine);

/// The work X at which the wheel's lower face touches the end of a blank from above, at the swivel of the set-up and at
/// Z = 0. The blank is longer than the tool by the stock of the job's operation.
/// @param diameter diameter of the blank [m].
double touchX(const GrindJob& job, double diameter);

/// The work Y at which the largest circumference of the job's wheel touches a blank.
/// @param diameter diameter of the blank [m].
double touchY(const GrindJob& job, double diameter);

/// Why the largest circumference of the wheel would not touch the highest line of a blank, so that touchY() would be
/// wrong; empty if it would touch it. For the operator, in mm.
/// @param z work position of Z [m].
std::string heightRefusal(const GrindJob& job, double z);

}  // namespace grinder
