#pragma once

#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/ground_cutter.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grinder {

/// A point of a section, about the cutter's axis.
struct PolarPoint {
  double radius = 0;  ///< [m]
  double turns = 0;   ///< counted as A, but in whole turns: a multiple of 2^-40, so that turns come off exactly

  double angle() const noexcept { return 2 * units::kPi * turns; }  ///< [rad]
};

/// The point at a part of the way from one to another, in radius and angle.
PolarPoint between(const PolarPoint& from, const PolarPoint& to, double part) noexcept;

/// What a part of the cutter's surface is. A relieved land is kPrimary as far as the relief at its edge reaches.
enum class SurfaceKind : std::uint8_t { kRakeFace, kFluteBack, kLand, kPrimary, kEndFace, kShank, kCut };

/// How the points of an outline follow one another. It is the same in every section, so that sections can be joined
/// point by point. The outline goes around with rising angles, and for each flute in turn has its floor, its high wall
/// in rings from the floor out, the land in columns, and the low wall of the next flute in rings back in to its floor.
struct OutlineGrid {
  std::size_t teeth = 0;
  std::size_t rings = 0;    ///< of a wall, from floor to outer circle
  std::size_t columns = 0;  ///< of a land
  bool relieved = false;    ///< lands are relieved, for kind()

  /// The columns of a relieved land from its edge to where the relief at the edge ends.
  std::size_t primary() const noexcept { return (columns + 1) / 2; }
  std::size_t perTooth() const noexcept { return 2 * rings + columns; }
  std::size_t size() const noexcept { return teeth * perTooth(); }

  /// The index of a point of the high wall of flute `i`: ring 0 is its floor.
  std::size_t high(std::size_t i, std::size_t ring) const noexcept { return i % teeth * perTooth() + ring; }
  /// The index of a point of the land behind the high wall of flute `i`: the ends belong to the walls as well.
  std::size_t land(std::size_t i, std::size_t column) const noexcept { return high(i, rings + column); }
  /// The index of a point of the low wall of flute `i` + 1: ring 0 is its floor.
  std::size_t lowOfNext(std::size_t i, std::size_t ring) const noexcept {
    return ring == 0 ? high(i + 1, 0) : high(i, 2 * rings + columns - ring);
  }

  /// What the line from a point to the next belongs to.
  SurfaceKind kind(std::size_t point, CutDirection direction) const noexcept;
  /// Which tooth: the one whose edge is on the same body between two flutes.
  std::size_t tooth(std::size_t point, CutDirection direction) const noexcept;
};

/// The outline of the ground cutter in a section at A = 0, as a closed polygon. A flute that removes nothing there has
/// all its points at one place of the outer circle. Where no land is left, a tooth ends in the point in which the walls
/// of its two flutes meet; what they cut off outside of it is not part of the cutter.
///
/// The rings of a wall lie closer to one another toward the floor, where the arcs open like a root. Where a shallow
/// flute lies with its floor within a deep one, it is left out.
/// @param blank_radius the outer circle [m].
/// @return points in the order of the grid.
/// @throw std::invalid_argument if the core is cut through, or the grid does not suit the cutter.
std::vector<PolarPoint> sectionOutline(const GroundCutter& cutter, double x, double blank_radius,
                                       const OutlineGrid& grid);

}  // namespace grinder
