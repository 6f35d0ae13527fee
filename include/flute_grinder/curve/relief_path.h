#pragma once

#include "flute_grinder/curve/conical_cutter.h"

#include <array>

namespace grinder {

/// Where a relief begins and with which clearance: at the edge, or behind it on the surface of another relief.
struct ReliefStart {
  double clearance = 0;    ///< radial clearance of the surface at the start [rad]
  double radius_part = 1;  ///< radius of the start, as a fraction of the cutter's radius
  double behind = 0;       ///< angle from the edge to the start [rad]
};

/// The straight wheel that grinds a relief with its rim, and its set-up on the machine.
struct ReliefWheel {
  double nominal_radius = 0;  ///< radius of the wheel that touches the small end's circle at Y = 0 [m]
  double wear = 0;            ///< difference of the wheel's radius below nominal_radius [m]
  double width = 0;           ///< width of the wheel [m]
  double swivel = 0;          ///< angle of the wheel's plane to the cutter's axis, as for a flute [rad]
  double height = 0;          ///< height of the wheel's centre above the cutter's axis at Z = 0 [m]
  /// Corner radii at the lower and the upper face; the rim is the cylinder between them [m].
  std::array<double, 2> corner_radius{};
};

/// The path of a wheel whose rim grinds a relief behind an edge with a constant spiral angle. The relief begins at the
/// same machine angle phi all along the edge. With the wheel's normal N at that start, the wheel's centre is
///
///     P(s) + R_w N - q w,    P(s) = (s, rho R(s) cos phi, rho R(s) sin phi),    A = A_edge(s) + behind - phi
///
/// with the wheel's axis w and the contact's position q on the wheel's width. Everything but P is constant, so this is
/// the published law of a flute with another rake angle, whose sine is rho sin phi, a taper and a shift along X. N is
/// normal to w and to the motion of the relief's start, which gives phi in closed form:
///
///     sin(clearance + phi) = -tan(swivel) (rho tan C cos(clearance) + rho tan S sin(clearance))
///
/// Signs are for a right-hand cutter; a left-hand one is its mirror image. See docs/algorithm.md.
class ReliefPath {
 public:
  /// A point of the ground surface in a cross section.
  struct Place {
    double radius = 0;     ///< [m]
    double behind = 0;     ///< angle from the edge [rad]
    double clearance = 0;  ///< clearance of the surface against the circle through the point [rad]
  };

  /// @throw std::invalid_argument if the swivel is too large for the clearance, so that no normal of the rim gives it,
  ///        or if the edge does not lie on the rim.
  ReliefPath(const ConicalCutter& cutter, const ReliefStart& start, const ReliefWheel& wheel);

  /// The height that puts the relief's start at a given point of the rim. Throws like the constructor if no normal
  /// gives the clearance.
  /// @param contact the point, from the middle of the wheel's width along the wheel's axis [m].
  static double heightFor(const ConicalCutter& cutter, const ReliefStart& start, const ReliefWheel& wheel,
                          double contact);

  /// The height with which the rim reaches a given length behind the relief's start. Throws like heightFor().
  /// @param reach the length, see reach() [m].
  static double heightForReach(const ConicalCutter& cutter, const ReliefStart& start, ReliefWheel wheel, double reach);

  /// The cutter whose law Z follows: the asked cutter with the path's rake angle.
  const ConicalCutter& cutter() const noexcept { return path_cutter_; }

  double xShift() const noexcept { return x_shift_; }  ///< shift of X against the section where the relief begins [m]
  double y() const noexcept { return y_; }             ///< Y at X = 0 of the last stroke [m]
  double taper() const noexcept { return taper_; }     ///< slope added to the cone's dY/dX
  double a() const noexcept { return a_; }             ///< angle added to the edge's A(X - shift) [rad]
  double phi() const noexcept { return phi_; }         ///< machine angle of the relief's start, see the class [rad]

  /// The point of the rim where the relief begins, from the middle of the wheel's width along its axis [m].
  double contact() const noexcept { return contact_; }

  /// Decrease of Y per unit of wear.
  double yPerWear() const noexcept { return 1 / normal_y_; }

  /// The infeed of the last stroke: its Y below the Y at which the rim first touches a blank without flutes or reliefs.
  /// Takes a tenth of a millisecond to compute [m].
  double depth() const noexcept;

  /// How far beyond either end of the flute the relief's start must travel to complete the surface up to the rim's end
  /// [m].
  double beyondEnd() const noexcept { return beyond_end_; }
  double beyondShank() const noexcept { return beyond_shank_; }

  /// The maximum width of the relief along the rim [m].
  double reach() const noexcept { return side_ > 0 ? rim_to_ - contact_ : contact_ - rim_from_; }

  /// The surface in a cross section.
  /// @param x X of the section [m].
  /// @param along distance along the rim from the start of the relief toward the heel [m].
  /// @return NaN where the rim forms no surface.
  Place surface(double x, double along) const noexcept;

  /// The surface at a given chord from its start across the section, e.g. a land's width.
  /// @param x X of the section [m].
  /// @param width length of the chord [m].
  /// @return a place with radius NaN if the chord ends beyond the rim.
  Place surfaceAt(double x, double width) const noexcept;

 private:
  struct Point {
    double x, y, z, normal_y, normal_z;
  };
  /// @param w point of the rim, along the wheel's axis from the start of the relief [m].
  Point contactPoint(double s, double w) const noexcept;
  /// Position of the relief's start along the edge while a given point of the rim forms a given section; NaN if there
  /// is none.
  double formedAt(double x, double w) const noexcept;
  Place surfaceOf(double x, double w) const noexcept;
  double touchDepth(double s) const noexcept;

  ReliefStart start_;
  double radius_, tan_cone_, tan_spiral_;  ///< the cutter's values at the small end, as a right-hand cutter
  double wheel_radius_, half_width_, sin_, cos_;
  double rim_from_, rim_to_;  ///< ends of the rim, from the middle of the width along the wheel's axis
  double side_ = 1;           ///< -1 if the relief lies on the rim toward its lower face
  double phi_ = 0;
  double normal_x_ = 0, normal_y_ = 0, normal_z_ = 0;
  double contact_ = 0;
  ConicalCutter path_cutter_;
  double x_shift_ = 0, y_ = 0, taper_ = 0, a_ = 0, beyond_end_ = 0, beyond_shank_ = 0;
};

}  // namespace grinder
