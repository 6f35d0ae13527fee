#pragma once

#include "flute_grinder/curve/conical_cutter.h"
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
  /// Some of the volumes, by their index, ascending.
  using Volumes = std::vector<std::size_t>;

  /// @param box of the solid.
  SolidCut(const std::vector<RemovedVolume>& volumes, const Box& box);

  bool isEmpty() const noexcept { return volumes_.empty(); }

  /// Largest X at which a volume is in the solid's box [m].
  double reach() const noexcept { return reach_; }

  /// The volumes in a range of X [m].
  Volumes between(double from, double to) const;

  /// Finds behind which planes of each of some volumes a point is.
  /// @param sides gets a number for each volume.
  void findSides(const Volumes& of, const Eigen::Vector3d& at, std::uint64_t* sides) const noexcept;

  /// Those of some volumes that a piece with these corners may reach into; nothing if one of them removes all of it.
  /// @param of,corners as in findSides().
  static std::optional<Volumes> touched(const Volumes& of, std::initializer_list<const std::uint64_t*> corners);

  /// The parts of a triangle that are left.
  std::vector<Polygon> outside(const Volumes& touched, Polygon triangle) const;

  /// Adds the faces that volumes leave on a tetrahedron, facing into the volumes.
  /// @param tetrahedron tetrahedron of positive volume; if it is turned inside out, so are its faces.
  void addFaces(const Volumes& touched, const TetrahedronCorners& tetrahedron, std::vector<CutFace>& faces) const;

 private:
  void addFacesOf(std::size_t volume, const Volumes& touched, const TetrahedronCorners& tetrahedron,
                  std::vector<CutFace>& faces) const;

  std::vector<RemovedVolume> volumes_;
  std::vector<Range> reaches_;  ///< X of each of them, wider by the rounding of corners [m]
  double reach_;
};

}  // namespace grinder
