#pragma once

#include "flute_grinder/job/valid_job.h"

#include <optional>
#include <string>

namespace grinder {

/// A set-up for a relief.
struct ReliefSetup {
  double swivel = 0;     ///< [rad]
  double height = 0;     ///< of the wheel's centre above the cutter's axis at Z = 0 [m]
  double width = 0;      ///< of the rim behind the relief's start [m]
  double next_edge = 0;  ///< how near the wheel comes to the next tooth's edge [rad]
  /// Minimum and maximum over the flute, at the land's end [rad]; nothing if the rim alone would not reach that.
  std::optional<Range> land_end_clearance;
  std::string refused;  ///< why there is none, of the swivel that comes nearest; else empty
};

/// Finds swivel and height for a relief that checkGroundCutter() accepts, with some clearance left at the land's end:
/// the swivel nearest to the flutes' that leaves a margin, or else the one that leaves most. If the rim does that at no
/// swivel, the set-up is one where the wheel's faces grind a part. Takes some hundredths of a second, or, if it is
/// refused, up to some seconds.
/// @param job of a relief; the swivel that it has is tried, too. @param flutes with their laws.
/// @param swivel to which the machine swivels [rad]. @param asked swivel, instead of the nearest one [rad].
ReliefSetup findReliefSetup(const GrindJob& job, const ValidJob& flutes, const Range& swivel,
                            std::optional<double> asked);

}  // namespace grinder
