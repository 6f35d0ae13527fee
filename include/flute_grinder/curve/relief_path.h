#pragma once

#include "flute_grinder/curve/conical_cutter.h"

#include <array>

namespace grinder {

/// The clearance of a relief, and where it begins: at the edge, or behind it on what another relief has left.
struct ReliefStart {
  double clearance = 0;    ///< of the surface there, radial [rad]
  double radius_part = 1;  ///< its radius, as a part of the cutter's
  double behind = 0;       ///< the angle from the edge to it [rad]
};

/// The straight wheel that grinds a relief with its rim, and how the machine is set for it.
struct ReliefWheel {
  double nominal_radius = 0;  ///< for which Y = 0 touches the small end's circle [m]
  double wear = 0;            ///< of the radius below that [m]
  double width = 0;           ///< [m]
  double swivel = 0;          ///< as for a flute [rad]
  double height = 0;          ///< of the wheel's centre above the cutter's axis at Z = 0 [m]
  /// At the lower and the upper face; the rim is what lies between them [m].
  std::array<double, 2> corner_radius{};
};

/// The path of a wheel whose rim grinds a relief behind an edge with a constant spiral angle. The relief begins at the
/// same angle of the machine all along the edge, phi, and with the wheel's normal N there the wheel's centre is
///
///     P(s) + R_w N - q w,    P(s) = (s, rho R(s) cos phi, rho R(s) sin phi),    A = A_edge(s) + behind - phi
///
/// with the wheel's axis w and the place q on its width. Everything but P is constant, so this is the published law of
/// a flute with the sine of another rake angle, rho sin phi, a taper and a shift. N is normal to w and to the motion of
/// the relief's start, which leaves phi in closed form:
///
///     sin(clearance + phi) = -tan(swivel) (rho tan C cos(clearance) + rho tan S sin(clearance))
///
/// All signs are a right-hand cutter's; a left-hand one is its mirror image. See docs/algorithm.md.
class ReliefPath {
 public:
  /// A place of the surface that the rim leaves, in a section.
  struct Place {
    double radius = 0;     ///< [m]
    double behind = 0;     ///< angle from the edge [rad]
    double clearance = 0;  ///< of the surface against the circle through it [rad]
  };

  /// @throw std::invalid_argument if the swivel is too large for the clearance, so that no normal of the rim has it, or
  ///        if the edge does not lie on the rim.
  ReliefPath(const ConicalCutter& cutter, const ReliefStart& start, const ReliefWheel& wheel);

  /// The height with which the relief's start lies at a place of the rim. Throws as the constructor if no normal has
  /// the clearance. @param contact the place, from the middle of the width along the wheel's axis [m].
  static double heightFor(const ConicalCutter& cutter, const ReliefStart& start, const ReliefWheel& wheel,
                          double contact);

  /// The height with which the rim reaches so far behind the relief's start. Throws as heightFor().
  /// @param reach see reach() [m].
  static double heightForReach(const ConicalCutter& cutter, const ReliefStart& start, ReliefWheel wheel, double reach);

  /// The cutter by whose law Z follows: its rake angle alone is the path's.
  const ConicalCutter& cutter() const noexcept { return path_cutter_; }

  double xShift() const noexcept { return x_shift_; }  ///< of X against the section where the relief begins [m]
  double y() const noexcept { return y_; }             ///< Y at X = 0 of the last stroke [m]
  double taper() const noexcept { return taper_; }     ///< added to the cone's dY/dX
  double a() const noexcept { return a_; }             ///< added to the edge's A(X - shift) [rad]
  double phi() const noexcept { return phi_; }         ///< where the relief begins, see the class [rad]

  /// Where on the rim the relief begins, from the middle of the wheel's width along its axis [m].
  double contact() const noexcept { return contact_; }

  /// How much lower Y must go for a wheel worn by one more unit of length.
  double yPerWear() const noexcept { return 1 / normal_y_; }

  /// How far the last stroke's Y lies below that at which the rim first touches the blank, if nothing was ground
  /// before. Takes a tenth of a millisecond [m].
  double depth() const noexcept;

  /// How far beyond the flute's ends the relief's start must go for the surface to be complete up to the rim's end
  /// [m].
  double beyondEnd() const noexcept { return beyond_end_; }
  double beyondShank() const noexcept { return beyond_shank_; }

  /// How far along the rim the relief can reach [m].
  double reach() const noexcept { return side_ > 0 ? rim_to_ - contact_ : contact_ - rim_from_; }

  /// The surface in a section. @param x of the section [m]. @param along the rim, from where the relief begins toward
  /// the heel [m]. @return NaN where the rim forms none.
  Place surface(double x, double along) const noexcept;

  /// Where the surface is so far from its start, in a straight line across the section: a land's width.
  /// @param x of the section [m]. @param width [m]. @return nothing beyond the rim's end: its radius is then NaN.
  Place surfaceAt(double x, double width) const noexcept;

 private:
  struct Point {
    double x, y, z, normal_y, normal_z;
  };
  /// @param w place on the rim, along the wheel's axis from where the relief begins [m].
  Point contactPoint(double s, double w) const noexcept;
  /// Which place of the edge the relief's start is at as a place of the rim forms a section; NaN if none is.
  double formedAt(double x, double w) const noexcept;
  Place surfaceOf(double x, double w) const noexcept;
  double touchDepth(double s) const noexcept;

  ReliefStart start_;
  double radius_, tan_cone_, tan_spiral_;  ///< of the cutter at the small end, as a right-hand one
  double wheel_radius_, half_width_, sin_, cos_;
  double rim_from_, rim_to_;  ///< from the middle of the width along the wheel's axis
  double side_ = 1;           ///< -1 if the relief lies on the rim toward its lower face
  double phi_ = 0;
  double normal_x_ = 0, normal_y_ = 0, normal_z_ = 0;
  double contact_ = 0;
  ConicalCutter path_cutter_;
  double x_shift_ = 0, y_ = 0, taper_ = 0, a_ = 0, beyond_end_ = 0, beyond_shank_ = 0;
};

}  // namespace grinder
