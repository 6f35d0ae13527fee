#pragma once

#include "flute_grinder/machine/machine_geometry.h"

#include <optional>
#include <string>

namespace grinder {

struct GrindJob;

/// What the axes read when the wheel touches a cylinder of any diameter D. A cone it touches beside the line that is
/// nearest to it, with its centre lower than that.
struct TouchReadings {
  double y = 0;        ///< (D - D1) / 2 and this, with the circumference at the height of the cutter's axis [m]
  double z_for_y = 0;  ///< Z at which the circumference, where it is largest, stands at that height [m]
  double z = 0;        ///< D / 2 and this, with the lower face on top of the blank and the swivel at 0 [m]
};

/// @param job with its set-up.
/// @param above_swivel of the wheel's middle above the swivel's centre, along the spindle: turning the swivel from 0 to
/// S
///        lowers the wheel by 1 - cos S of it [m].
TouchReadings touchReadings(const GrindJob& job, double above_swivel = 0);

/// How far the middle of a job's wheel lies above the swivel's centre, along the spindle [m]; nothing unless the job
/// names a wheel file that has the wheel's place on the flange.
/// @param file of the job. @param machine its flange alone is used. @throw JobFileError if a file cannot be read.
std::optional<double> wheelAboveSwivel(const std::string& file, const GrindJob& job, const MachineGeometry& machine);

/// The work Y at which the job's wheel touches a blank with its maximum diameter. @param diameter of the blank [m].
double touchY(const GrindJob& job, double diameter);

/// Why the wheel would not touch a blank on its highest line, with what is largest on the wheel, so that touchY() would
/// be wrong; empty if it would. For the operator, in mm.
/// @param z work position of Z [m].
std::string heightRefusal(const GrindJob& job, double z);

}  // namespace grinder
