#pragma once

#include "flute_grinder/job/valid_job.h"

#include <optional>
#include <string>

namespace grinder {

/// A set-up for a relief.
struct ReliefSetup {
  double swivel = 0;     ///< [rad]
  double height = 0;     ///< height of the wheel's centre above the cutter's axis at Z = 0 [m]
  double width = 0;      ///< width of the rim behind the relief's start [m]
  double next_edge = 0;  ///< smallest angle between the wheel and the next tooth's edge [rad]
  /// Minimum and maximum at the land's end over the flute; nothing if the rim alone would not reach it [rad].
  std::optional<Range> land_end_clearance;
  std::string refused;  ///< why the best swivel is refused; empty if it is not
};

/// Finds swivel and height for a relief that checkGroundCutter() accepts, with some clearance left at the land's end:
/// the swivel nearest to the flutes' that leaves a margin, or else the swivel that leaves most. If the rim cannot do
/// that at any swivel, the wheel's faces grind a part. Takes some hundredths of a second, or up to some seconds if it
/// is refused.
/// @param job job of a relief; its swivel is tried, too.
/// @param flutes job of the flutes, with its laws.
/// @param swivel range that is searched [rad].
/// @param asked swivel to use instead of the nearest one [rad].
ReliefSetup findReliefSetup(const GrindJob& job, const ValidJob& flutes, const Range& swivel,
                            std::optional<double> asked);

}  // namespace grinder
