#pragma once

#include "flute_grinder/tool/end_volumes.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace grinder {

/// A line in Y and Z of the cutter's frame at A = 0 [m].
using EndPolyline = std::vector<Eigen::Vector2d>;

/// A part of the end: a tooth's gash, a flank or its chamfer, or what is left of the blank's end, which has tooth 0.
struct EndRegion {
  SurfaceKind kind;
  std::uint16_t tooth;
  std::vector<EndPolyline> outlines;  ///< closed; one about a hole runs the other way round
};

/// A line in which a tooth's primary flank, or its chamfer, meets the face of its gash or of its flute.
struct EndEdge {
  std::uint16_t tooth;
  EndPolyline line;  ///< from the axis out
};

/// The end of a tool, projected along its axis.
struct EndView {
  std::vector<EndRegion> regions;  ///< from far to near for who looks from the end
  std::vector<EndEdge> edges;      ///< in the order of the teeth
};

/// The view of a tool's end; empty if nothing is taken from it. Takes some tenths of a second.
/// @throw std::invalid_argument like cutterSolid().
EndView endView(const GroundCutter& cutter, const EndVolumes& end);

}  // namespace grinder
