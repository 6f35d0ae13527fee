#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grinder {

/// A point of a section in polar coordinates about the cutter's axis.
struct PolarPoint {
  double radius = 0;  ///< [m]
  double turns = 0;   ///< angle like A, in turns: a multiple of 2^-40, so that whole turns subtract exactly

  double angle() const noexcept { return 2 * units::kPi * turns; }  ///< [rad]
};

/// The point at a fraction of the way between two points, linear in radius and angle.
/// @param bend turns by which the angle is ahead of that.
PolarPoint between(const PolarPoint& from, const PolarPoint& to, double part, double bend = 0) noexcept;

/// The kind of a part of the cutter's surface. A relieved land is kPrimary up to the end of the relief at its edge.
enum class SurfaceKind : std::uint8_t {
  kRakeFace,
  kFluteBack,
  kLand,
  kPrimary,
  kEndFace,
  kGash,
  kEndPrimary,
  kEndSecondary,
  kChamfer,
  kShank,
  kCut
};

/// The order of an outline's points. It is the same in every section, so that sections can be joined point by point.
/// The outline runs around with rising angles. For each flute it has the floor, the high wall in rings from the floor
/// out, the land in columns, and the low wall of the next flute in rings back to its floor.
struct OutlineGrid {
  std::size_t teeth = 0;
  std::size_t rings = 0;    ///< rings of a wall, from floor to outer circle
  std::size_t columns = 0;  ///< columns of a land
  bool relieved = false;    ///< whether lands are relieved, for kind()

  /// The number of columns of a relieved land from its edge to the end of the relief there.
  std::size_t primary() const noexcept { return (columns + 1) / 2; }
  std::size_t perTooth() const noexcept { return 2 * rings + columns; }
  std::size_t size() const noexcept { return teeth * perTooth(); }

  /// The index of a point of the high wall of flute `i`: ring 0 is its floor.
  std::size_t high(std::size_t i, std::size_t ring) const noexcept { return i % teeth * perTooth() + ring; }
  /// The index of a point of the land behind the high wall of flute `i`: its ends are also points of the walls.
  std::size_t land(std::size_t i, std::size_t column) const noexcept { return high(i, rings + column); }
  /// The index of a point of the low wall of flute `i` + 1: ring 0 is its floor.
  std::size_t lowOfNext(std::size_t i, std::size_t ring) const noexcept {
    return ring == 0 ? high(i + 1, 0) : high(i, 2 * rings + columns - ring);
  }

  /// The kind of the line from a point to the next.
  SurfaceKind kind(std::size_t point, CutDirection direction) const noexcept;
  /// The tooth of a point: the tooth whose edge is on the same body between two flutes.
  std::size_t tooth(std::size_t point, CutDirection direction) const noexcept;
};

/// The outline of the ground cutter in a section at A = 0, as a closed polygon. All points of a flute that removes
/// nothing there coincide on the outer circle. Where no land is left, a tooth ends at the point where the walls of its
/// two flutes meet; what they cut off outside that point is not part of the cutter.
///
/// The rings of a wall are closer together toward the floor, where the arcs open like a square root. A shallow flute
/// whose floor is within a deep flute is left out.
/// @param blank_radius radius of the outer circle [m].
/// @return points in the order of the grid.
/// @throw std::invalid_argument if the core is cut through, or the grid does not suit the cutter.
std::vector<PolarPoint> sectionOutline(const GroundCutter& cutter, double x, double blank_radius,
                                       const OutlineGrid& grid);

}  // namespace grinder
