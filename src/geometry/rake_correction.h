#pragma once

#include "flute_grinder/geometry/ground_cutter.h"
#include "flute_grinder/motion/job_plan.h"

#include <optional>

namespace grinder {

/// A correction of Z, and the rake that is ground with it.
struct RakeCorrection {
  ZCorrection z;
  double min_rake = 0, max_rake = 0;  ///< over the flute [rad]
};

/// The correction of Z over X with which the rake is the same over the whole flute, which no set-up makes it with the
/// published law. Found by Newton's method on the spline's coefficients, in a
/// tenth of a second.
/// @param nominal_radius of the wheel, for which Y = 0 touches the small end [m].
/// @param stroke with its overtravel, without a correction; the spline covers it.
/// @param rake asked, radial [rad].
/// @param watch if given, may make it give up, within some milliseconds.
/// @return the best correction found, whose rake the caller compares with what is allowed; nothing if the flute is not
///         ground over its whole length.
/// @throw ReasonError if it has given up.
std::optional<RakeCorrection> correctRake(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius,
                                          const WheelSetup& setup, const GrindStroke& stroke, double rake,
                                          const PlanWatch& watch = {});

}  // namespace grinder
