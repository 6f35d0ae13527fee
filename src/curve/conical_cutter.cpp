#include "flute_grinder/curve/conical_cutter.h"

#include "flute_grinder/base/units.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace grinder {

namespace {

void require(bool good, const char* name, double value, const char* allowed) {
  if (good) return;
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "cutter." << name << " = " << value << "; allowed: " << allowed;
  throw std::invalid_argument(text.str());
}

}  // namespace

ConicalCutter::ConicalCutter(const CutterGeometry& geometry)
    : geometry_(geometry),
      tan_cone_(std::tan(geometry.cone_angle)),
      tan_spiral_(std::tan(geometry.spiral_angle)),
      z_per_y_(std::sin(geometry.cut == CutDirection::kLeftHand ? -geometry.rake_angle : geometry.rake_angle)),
      edge_per_travel_(std::sqrt(1 + tan_cone_ * tan_cone_ + tan_spiral_ * tan_spiral_)),
      cos_helix_to_generatrix_(1 / std::hypot(1, tan_spiral_ * std::cos(geometry.cone_angle))) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  const auto acute = [](double v) { return std::abs(v) < units::kPi / 2; };
  require(positive(geometry.end_diameter), "end_diameter", geometry.end_diameter, "finite and positive [m]");
  require(acute(geometry.cone_angle), "cone_angle", geometry.cone_angle, "within (-pi/2, pi/2) [rad]");
  require(acute(geometry.spiral_angle), "spiral_angle", geometry.spiral_angle, "within (-pi/2, pi/2) [rad]");
  require(acute(geometry.rake_angle), "rake_angle", geometry.rake_angle, "within (-pi/2, pi/2) [rad]");
  require(positive(geometry.flute_length), "flute_length", geometry.flute_length, "finite and positive [m]");
  require(radius(geometry.flute_length) > 0, "cone_angle", geometry.cone_angle,
          "a cone that does not close before the flute ends");
}

}  // namespace grinder
