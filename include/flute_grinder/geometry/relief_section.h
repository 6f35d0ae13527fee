#pragma once

#include "flute_grinder/geometry/ground_cutter.h"

#include <optional>
#include <vector>

namespace grinder {

/// What reliefs leave of a tooth in a section.
struct ReliefSection {
  double edge_radius = 0;           ///< what is left at the edge: the blank's, unless a relief undercuts it [m]
  std::optional<double> clearance;  ///< of the first relief at the edge, radial [rad]
  std::optional<double> land;       ///< width of the first relief, up to the second or to the heel [m]
  std::optional<double> land_end_clearance;  ///< of the first relief there [rad]
  std::optional<double>
      heel;  ///< from the edge to where the land meets the next flute; nothing if a relief ends before [m]
  double next_edge =
      0;  ///< how far the reliefs' far ends stay from the next tooth's rake face, at least; < 0: cut [rad]
};

/// Measures the reliefs of a tooth of a ground cutter.
/// @param section of the cutter, as from GroundCutter::section().
/// @param tooth that has an edge in the section, as its neighbours.
/// @param reliefs their last strokes, the first relief first, for a tooth at angle 0.
ReliefSection measureRelief(const GroundCutter& cutter, const GroundSection& section, std::size_t tooth,
                            const std::vector<WheelSweep>& reliefs);

}  // namespace grinder
