#pragma once

#include "flute_grinder/tool/removed_volume.h"

#include <array>
#include <vector>

namespace grinder {

using Polygon = std::vector<Eigen::Vector3d>;  ///< convex and flat, corners in order; nothing if there are less than 3
using TetrahedronCorners = std::array<Eigen::Vector3d, 4>;

/// The part of a polygon on one side of a plane; the plane itself counts as behind. An edge that is cut gets the same
/// point in each of its polygons.
Polygon clipped(const Polygon& polygon, const Plane& plane, bool in_front);

/// The section of a tetrahedron with a plane, its corners counterclockwise as seen from the plane's front; clockwise in
/// a tetrahedron that is turned inside out, so that it cancels the doubly covered parts.
Polygon section(const TetrahedronCorners& corners, const Plane& plane);

/// A box along the axes.
struct Box {
  Eigen::Vector3d least, most;  ///< [m]
};

/// The part of a box that is in front of planes.
class ConvexPart {
 public:
  explicit ConvexPart(const Box& box);

  /// @return whether the plane takes anything away.
  bool cut(const Plane& plane);

  bool isEmpty() const noexcept { return faces_.empty(); }
  bool hasFaceOn(const Plane& plane) const;
  Box bounds() const;

 private:
  std::vector<Polygon> faces_;
};

}  // namespace grinder
