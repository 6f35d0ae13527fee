#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace grinder {

/// A wedge to cut out of a solid to show its inside: the space between two half planes that end at the X axis.
struct Wedge {
  double from = 0, to = 0;  ///< angles of the half planes, less than half a turn apart [rad]
};

/// Cuts a wedge out of flat-faced pieces.
class WedgeCut {
 public:
  using Polygon = std::vector<Eigen::Vector3d>;  ///< convex, corners in order

  /// @throw std::invalid_argument unless `to` is beyond `from`, by less than half a turn.
  explicit WedgeCut(const Wedge& wedge);

  /// The parts of a triangle outside the wedge. A cut edge gets the same points in both of its triangles.
  std::vector<Polygon> outside(const std::array<Eigen::Vector3d, 3>& triangle) const;

  /// The faces that the wedge leaves on a tetrahedron, facing into the wedge.
  /// @param tetrahedron tetrahedron of positive volume; if it is turned inside out, so are its faces.
  std::vector<Polygon> faces(const std::array<Eigen::Vector3d, 4>& tetrahedron) const;

 private:
  Eigen::Vector3d from_, to_;  ///< normals of the half planes, into the wedge
};

}  // namespace grinder
