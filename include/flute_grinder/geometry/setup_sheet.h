#pragma once

#include "flute_grinder/geometry/job_setup.h"

#include <string>

namespace flute_grinder {

/// What the axes read when the wheel touches a blank, of any diameter D where it touches.
struct TouchOff {
  double y = 0;        ///< (D - D1) / 2 and this, with the circumference at the height of the cutter's axis [m]
  double z_for_y = 0;  ///< Z at which the circumference, where it is largest, stands at that height [m]
  double z = 0;        ///< D / 2 and this, with the lower face on top of the blank and the swivel at 0 [m]
};

/// @param job with its set-up.
TouchOff touchOffOf(const GrindJob& job);

/// The height of a face of the wheel above the cutter's axis at Z = 0, where it is deepest in the cutter [m].
double upperFaceHeight(const GrindJob& job);
double lowerFaceHeight(const GrindJob& job);

/// The set-up sheet for the operator, in mm and deg: what to set, what to touch and what the axes then read, what comes
/// out, and what limits it.
/// @param swivel that the machine allows [rad].
std::string setupSheet(const JobSetup& setup, const Range& swivel);

}  // namespace flute_grinder
