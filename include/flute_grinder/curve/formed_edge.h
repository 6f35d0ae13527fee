#pragma once

#include "flute_grinder/curve/conical_cutter.h"

namespace grinder {

/// The edge that a stroke forms. While the wheel's centre is at X, A is the angle of the edge at X - shift. `x_shift`
/// is the shift of A's curve along X that makes the ground edge the asked helix. It differs from the distance between
/// the centre and the point where the wheel forms the edge, since depth and height change along X. Real-time safe.
struct FormedEdge {
  ConicalCutter cutter;
  double x_shift = 0;  ///< [m]

  /// X of the edge on the cutter, for X of the wheel's centre [m].
  double x(double wheel_x) const noexcept { return wheel_x - x_shift; }

  /// The cutter's radius at x(wheel_x) [m].
  double radius(double wheel_x) const noexcept { return cutter.radius(x(wheel_x)); }

  /// The signed deviation at the cutter's surface, normal to the helix, that an error of A causes [m].
  double deviation(double wheel_x, double a_error) const noexcept {
    return a_error * radius(wheel_x) * cutter.cosHelixToGeneratrix();
  }
};

}  // namespace grinder
