#pragma once

#include "flute_grinder/base/enum_table.h"

namespace grinder {

/// The direction in which a cutter turns; it decides which wall of a flute is the rake face. The edges of a right-hand
/// cutter move toward decreasing A.
enum class CutDirection { kRightHand, kLeftHand };

/// Each direction with its name in job files.
inline constexpr EnumRow<CutDirection> kCutDirections[]{
    {CutDirection::kRightHand, "right_hand"},
    {CutDirection::kLeftHand, "left_hand"},
};
constexpr auto& rowsOf(CutDirection) noexcept { return kCutDirections; }

/// The figures of a conical end mill that the curve follows from, unchecked.
struct Cone {
  double end_diameter = 0;  ///< D1, diameter at the small end, X = 0 [m]
  double cone_angle = 0;    ///< C, half angle between axis and generatrix; negative for a back taper [rad]
  double spiral_angle = 0;  ///< S, from the axial direction: tan S = R dA/dX; negative for a left-hand helix [rad]
  double rake_angle = 0;    ///< r in Z = X tan C sin r [rad]
  double flute_length = 0;  ///< length of the flutes along the cutter's axis [m]
  CutDirection cut = CutDirection::kRightHand;
};

/// A closed interval, in the unit of what it describes.
struct Range {
  double from = 0, to = 0;
};

/// A conical end mill with constant rake and spiral angle (paper, section 2).
class ConicalCutter {
 public:
  /// @throw std::invalid_argument naming the bad value unless end diameter and flute length are finite and positive,
  ///        the three angles lie within (-pi/2, pi/2), and the radius stays positive up to the flute's end.
  explicit ConicalCutter(const Cone& cone);

  const Cone& cone() const noexcept { return cone_; }

  /// Local radius R(X) = D1/2 + X tan C [m].
  double radius(double x) const noexcept { return cone_.end_diameter / 2 + x * tan_cone_; }

  /// Radial position of the surface relative to X = 0: Y = X tan C, the paper's equation 1 [m].
  double y(double x) const noexcept { return x * tan_cone_; }

  /// Height that keeps the rake angle nearly constant: Z = X tan C sin r, the paper's equation 2, for a right-hand
  /// cutter; -Z for a left-hand one, its mirror image [m].
  double z(double x) const noexcept { return x * tan_cone_ * z_per_y_; }

  double tanCone() const noexcept { return tan_cone_; }      ///< dY/dX
  double tanSpiral() const noexcept { return tan_spiral_; }  ///< R dA/dX
  double zPerY() const noexcept { return z_per_y_; }         ///< dZ/dY: sin r, or -sin r for a left-hand cutter

  /// Length of cutting edge per unit of axial travel, sqrt(1 + tan^2 C + tan^2 S); surface feed divided by dX/dt.
  double edgePerTravel() const noexcept { return edge_per_travel_; }

  /// Cosine of the angle between helix and generatrix, atan(tan S cos C): the fraction of a circumferential deviation
  /// that is normal to the helix on the cone's surface.
  double cosHelixToGeneratrix() const noexcept { return cos_helix_to_generatrix_; }

 private:
  Cone cone_;
  double tan_cone_;
  double tan_spiral_;
  double z_per_y_;
  double edge_per_travel_;
  double cos_helix_to_generatrix_;
};

}  // namespace grinder
