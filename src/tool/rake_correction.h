#pragma once

#include "flute_grinder/motion/job_plan.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <optional>

namespace grinder {

/// A correction of Z, and the resulting rake.
struct RakeCorrection {
  ZCorrection z;
  double min_rake = 0, max_rake = 0;  ///< range of the rake over the flute [rad]
};

/// The correction of Z over X that makes the rake the same over the whole flute, which no set-up does with the
/// published law. Found by Newton's method on the spline's coefficients, in a tenth of a second.
/// @param nominal_radius radius of the wheel that touches the small end at Y = 0 [m].
/// @param stroke stroke with its overtravel, without a correction; the spline covers it.
/// @param rake asked radial rake [rad].
/// @param watch if given, it may stop the computation, within some milliseconds.
/// @return the best correction found, whose rake the caller must compare with the allowed range; nothing if the flute
///        is not ground over its whole length.
/// @throw ReasonError if it was stopped.
std::optional<RakeCorrection> correctRake(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius,
                                          const WheelSetup& setup, const GrindStroke& stroke, double rake,
                                          const PlanWatch& watch = {});

}  // namespace grinder
