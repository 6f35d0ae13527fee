#pragma once

#include "flute_grinder/tool/section_outline.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace grinder {

/// A plane with two sides.
struct Plane {
  Eigen::Vector3d normal;  ///< toward the front
  double offset = 0;       ///< of the plane's points along the normal

  /// Positive in front of the plane; in metres if the normal has unit length.
  double height(const Eigen::Vector3d& at) const noexcept { return normal.dot(at) - offset; }
};

/// A volume to take out of a solid: convex, or convex with a convex hollow that stays.
struct RemovedVolume {
  std::vector<Plane> body;               ///< the volume is in front of all of them
  std::vector<Plane> hollow;             ///< what is behind all of them stays; none for a volume without a hollow
  SurfaceKind kind = SurfaceKind::kCut;  ///< of the faces that the volume leaves
  std::uint16_t tooth = 0;               ///< tooth of these faces
};

/// A wedge to cut out of a solid to show its inside: the space between two half planes that end at the X axis.
/// @param from,to angles of the half planes [rad].
/// @throw std::invalid_argument unless `to` is beyond `from`, by less than half a turn.
RemovedVolume wedge(double from, double to);

}  // namespace grinder
