#pragma once

#include "flute_grinder/curve/conical_cutter.h"

namespace grinder {

/// The edge that a stroke forms, by X of the wheel's centre: while the centre is at X, A is that of the edge at X -
/// shift. The shift is not simply the distance from the centre to where the wheel forms the edge, since depth and
/// height change with it; it is the shift of the curve with which the ground edge is the asked helix. Real-time safe.
struct FormedEdge {
  ConicalCutter cutter;
  double x_shift = 0;  ///< [m]

  /// Along the cutter [m].
  double x(double wheel_x) const noexcept { return wheel_x - x_shift; }

  /// The cutter's radius there [m].
  double radius(double wheel_x) const noexcept { return cutter.radius(x(wheel_x)); }

  /// What an error of A makes there at the cutter's surface, normal to the helix; with its sign [m].
  double deviation(double wheel_x, double a_error) const noexcept {
    return a_error * radius(wheel_x) * cutter.cosHelixToGeneratrix();
  }
};

}  // namespace grinder
