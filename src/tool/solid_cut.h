#pragma once

#include "tool/polygon.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

namespace grinder {

/// A face that a removed volume leaves.
struct CutFace {
  Polygon polygon;
  SurfaceKind kind;
  std::uint16_t tooth;
};

/// Takes volumes out of flat-faced pieces.
class SolidCut {
 public:
  /// The volumes that pieces of a solid reach into, by their index.
  using Touched = std::vector<std::size_t>;

  /// @param box of the solid.
  SolidCut(const std::vector<RemovedVolume>& volumes, const Box& box);

  bool isEmpty() const noexcept { return volumes_.empty(); }
  std::size_t volumes() const noexcept { return volumes_.size(); }

  /// Largest X at which a volume is in the solid's box [m].
  double reach() const noexcept { return reach_; }

  /// Finds behind which planes of each volume a point is.
  /// @param sides gets a number for each volume.
  void findSides(const Eigen::Vector3d& at, std::uint64_t* sides) const noexcept;

  /// The volumes that a piece with these corners may reach into; nothing if one of them removes all of it.
  /// @param corners as from findSides().
  std::optional<Touched> touched(std::initializer_list<const std::uint64_t*> corners) const;

  /// The parts of a triangle that are left.
  std::vector<Polygon> outside(const Touched& touched, Polygon triangle) const;

  /// Adds the faces that volumes leave on a tetrahedron, facing into the volumes.
  /// @param tetrahedron tetrahedron of positive volume; if it is turned inside out, so are its faces.
  void addFaces(const Touched& touched, const TetrahedronCorners& tetrahedron, std::vector<CutFace>& faces) const;

 private:
  void addFacesOf(std::size_t volume, const Touched& touched, const TetrahedronCorners& tetrahedron,
                  std::vector<CutFace>& faces) const;

  std::vector<RemovedVolume> volumes_;
  double reach_;
};

}  // namespace grinder
