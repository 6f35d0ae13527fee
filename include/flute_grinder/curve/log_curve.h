#pragma once

#include "flute_grinder/curve/conical_cutter.h"

namespace grinder {

/// The logarithmic curve A(X) = (k/b) ln(1 + bX) of a helix with a constant spiral angle on a cone (the paper's
/// equation 4 with k = ab), in a form without singularity: a cylinder (b = 0), a back taper (b < 0), a straight
/// flute (k = 0) and a left-hand helix (k < 0) need no special case. Real-time safe.
class LogCurve {
 public:
  /// Takes b = 2 tan C / D1 and k = 2 tan S / D1 from a cutter.
  explicit LogCurve(const ConicalCutter& cutter) noexcept : LogCurve(cutter, 0) {}

  /// The cutter's curve shifted along X, A(X - shift), so that the ground edge is the asked helix: the curve of the
  /// cone moved by `x_shift`, with another A at X = 0. See FormedEdge.
  /// @param x_shift shift along X, finite; the cone's radius must be positive at X = -shift [m].
  LogCurve(const ConicalCutter& cutter, double x_shift) noexcept
      : LogCurve(2 * cutter.tanCone() / cutter.cone().end_diameter,
                 2 * cutter.tanSpiral() / cutter.cone().end_diameter) {
    if (x_shift == 0) return;
    a0_ = a(-x_shift);
    const double at_shift = u(-x_shift);
    b_ /= at_shift;
    k_ /= at_shift;
  }

  /// @param b relative growth of the radius per unit of length [1/m].
  /// @param k slope dA/dX at X = 0 [rad/m].
  LogCurve(double b, double k) noexcept : b_(b), k_(k) {}

  double b() const noexcept { return b_; }  ///< [1/m]
  double k() const noexcept { return k_; }  ///< [rad/m]

  /// Radius of the cone at X divided by its radius at X = 0; the curve exists where this is positive.
  double u(double x) const noexcept { return 1 + b_ * x; }

  /// A(X) [rad].
  double a(double x) const noexcept { return a0_ + k_ * x * log1pRatio(b_ * x); }

  /// A(X + dx) - A(X), accurate even if dx is much smaller than X [rad].
  double delta(double x, double dx) const noexcept {
    const double slope = this->slope(x);
    return slope * dx * log1pRatio(b_ * dx / u(x));
  }

  /// dA/dX [rad/m].
  double slope(double x) const noexcept { return k_ / u(x); }

 private:
  /// ln(1 + z)/z, 1 at z = 0.
  static double log1pRatio(double z) noexcept;

  double b_;
  double k_;
  double a0_ = 0;  ///< A at X = 0 [rad]
};

}  // namespace grinder
