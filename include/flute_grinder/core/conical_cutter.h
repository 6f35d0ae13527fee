#pragma once

namespace flute_grinder {

/// The plain figures of a conical end mill, unchecked: what a job file or a goal states.
struct CutterGeometry {
  double end_diameter = 0;  ///< D1, diameter at the small end, X = 0 [m]
  double cone_angle = 0;    ///< C, half angle from the axis to the generatrix; negative is a back taper [rad]
  double spiral_angle = 0;  ///< S, against axial travel: tan S = R dA/dX; negative is a left hand [rad]
  double rake_angle = 0;    ///< r [rad]
  double flute_length = 0;  ///< along the cutter's axis [m]
};

/// A conical end mill with constant rake and spiral angle (paper, section 2).
class ConicalCutter {
 public:
  /// @param geometry the cutter's figures.
  /// @throw std::invalid_argument naming the figure unless every one is finite, the diameter and the length are
  ///        positive, every angle lies within (-pi/2, pi/2), and the cone stays open up to the flute's end.
  explicit ConicalCutter(const CutterGeometry& geometry);

  const CutterGeometry& geometry() const noexcept { return geometry_; }

  /// Local radius R(X) = D1/2 + X tan C [m].
  double radius(double x) const noexcept { return geometry_.end_diameter / 2 + x * tan_cone_; }

  /// Radial position of the surface over that at X = 0: Y = X tan C, the paper's equation 1 [m].
  double y(double x) const noexcept { return x * tan_cone_; }

  /// Height that keeps the rake angle: Z = X tan C sin r, the paper's equation 2 [m].
  double z(double x) const noexcept { return x * tan_cone_ * sin_rake_; }

  double tanCone() const noexcept { return tan_cone_; }      ///< dY/dX
  double tanSpiral() const noexcept { return tan_spiral_; }  ///< R dA/dX
  double sinRake() const noexcept { return sin_rake_; }      ///< dZ/dY

  /// Length of cutting edge per length of axial travel, sqrt(1 + tan^2 C + tan^2 S): the surface feed over dX/dt.
  double edgePerTravel() const noexcept { return edge_per_travel_; }

  /// Cosine of the angle between helix and generatrix, atan(tan S cos C): the part of a circumferential deviation
  /// that is normal to the helix on the cone's surface.
  double cosHelixToGeneratrix() const noexcept { return cos_helix_to_generatrix_; }

 private:
  CutterGeometry geometry_;
  double tan_cone_;
  double tan_spiral_;
  double sin_rake_;
  double edge_per_travel_;
  double cos_helix_to_generatrix_;
};

}  // namespace flute_grinder
