#include "flute_grinder/curve/conical_cutter.h"

#include "flute_grinder/base/require.h"
#include "flute_grinder/base/units.h"

#include <cmath>

namespace grinder {

ConicalCutter::ConicalCutter(const Cone& cone)
    : cone_(cone),
      tan_cone_(std::tan(cone.cone_angle)),
      tan_spiral_(std::tan(cone.spiral_angle)),
      z_per_y_(std::sin(cone.cut == CutDirection::kLeftHand ? -cone.rake_angle : cone.rake_angle)),
      edge_per_travel_(std::sqrt(1 + tan_cone_ * tan_cone_ + tan_spiral_ * tan_spiral_)),
      cos_helix_to_generatrix_(1 / std::hypot(1, tan_spiral_ * std::cos(cone.cone_angle))) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  const auto acute = [](double v) { return std::abs(v) < units::kPi / 2; };
  require(positive(cone.end_diameter), "cutter.end_diameter", cone.end_diameter, "finite and positive [m]");
  require(acute(cone.cone_angle), "cutter.cone_angle", cone.cone_angle, "within (-pi/2, pi/2) [rad]");
  require(acute(cone.spiral_angle), "cutter.spiral_angle", cone.spiral_angle, "within (-pi/2, pi/2) [rad]");
  require(acute(cone.rake_angle), "cutter.rake_angle", cone.rake_angle, "within (-pi/2, pi/2) [rad]");
  require(positive(cone.flute_length), "cutter.flute_length", cone.flute_length, "finite and positive [m]");
  require(radius(cone.flute_length) > 0, "cutter.cone_angle", cone.cone_angle,
          "a cone that does not close before the flute ends");
}

}  // namespace grinder
