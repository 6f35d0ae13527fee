#pragma once

#include "flute_grinder/tool/removed_volume.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace grinder {

/// The part of the cutter that a solid shows.
struct SolidExtent {
  double from = 0, to = 0;    ///< X of the ground cone's ends [m]
  double shank_diameter = 0;  ///< diameter of the cylinder behind `to`, into which flutes may run out [m]
  double shank_to = 0;        ///< X of the cylinder's end; no cylinder unless beyond `to` [m]
};

/// The resolution of a solid.
struct SolidResolution {
  std::size_t sections = 60;  ///< number of sections over the cone; those that others foretell are not computed
  std::size_t rings = 64;     ///< number of rings of each wall in a section
  std::size_t around = 180;   ///< points of a whole circle, and layers per turn of the lands
};

struct SolidTriangle {
  std::array<std::uint32_t, 3> vertices;  ///< counterclockwise as seen from outside
  SurfaceKind kind;
  std::uint16_t tooth;  ///< tooth of the rake face, flute, land, gash or flank
};

/// A closed surface, but for cracks that only rounding explains. Coincident points are exactly equal, and no triangle
/// has two of them.
struct CutterSolid {
  std::vector<Eigen::Vector3d> vertices;  ///< vertices in the cutter's frame at A = 0 [m]
  std::vector<SolidTriangle> triangles;
  std::size_t open_edges = 0;  ///< edges along such cracks; 0 if nothing is removed

  double volume() const;  ///< enclosed volume [m^3]
};

/// The ground cutter as a closed surface through sections. Between them, layers are interpolated along the helix, so
/// the facets' error does not grow with the twist.
/// @param removed volumes to take out of it.
/// @throw std::invalid_argument like sectionOutline(), and for an unusable extent or resolution.
CutterSolid cutterSolid(const GroundCutter& cutter, const SolidExtent& extent, const SolidResolution& resolution = {},
                        const std::vector<RemovedVolume>& removed = {});

}  // namespace grinder
