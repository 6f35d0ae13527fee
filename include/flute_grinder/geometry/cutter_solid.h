#pragma once

#include "flute_grinder/geometry/section_outline.h"
#include "flute_grinder/geometry/wedge_cut.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace grinder {

/// Which part of the cutter a solid shows.
struct SolidExtent {
  double from = 0, to = 0;    ///< X of the ground cone's ends [m]
  double shank_diameter = 0;  ///< of the cylinder behind `to`, into which flutes may run out [m]
  double shank_to = 0;        ///< X of its end; none unless beyond `to` [m]
};

/// How fine a solid is.
struct SolidResolution {
  std::size_t sections = 60;  ///< that are computed over the cone
  std::size_t rings = 64;     ///< of each wall in a section
  std::size_t around = 180;   ///< points of a whole circle; also how many layers a turn of the helix has
};

struct SolidTriangle {
  std::array<std::uint32_t, 3> vertices;  ///< counterclockwise as seen from outside
  SurfaceKind kind;
  std::uint16_t tooth;  ///< whose rake face, flute or land it is
};

/// A closed surface. Where points coincide they are exactly equal, and no triangle has two of them.
struct CutterSolid {
  std::vector<Eigen::Vector3d> vertices;  ///< in the cutter's frame at A = 0 [m]
  std::vector<SolidTriangle> triangles;

  double volume() const;  ///< that is enclosed [m^3]
};

/// The ground cutter as a closed surface through sections. Between them, layers are interpolated along the helix, so
/// that the facets' error does not grow with the twist.
/// @param cut_out what is left out of it; its faces are of the kind kCut.
/// @throw std::invalid_argument as sectionOutline() and WedgeCut do, and if the extent or the resolution is not usable.
CutterSolid cutterSolid(const GroundCutter& cutter, const SolidExtent& extent, const SolidResolution& resolution = {},
                        const std::optional<Wedge>& cut_out = std::nullopt);

}  // namespace grinder
