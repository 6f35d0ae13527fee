#include "flute_grinder/curve/relief_path.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace grinder {

namespace {

constexpr int kHalvings = 60;          ///< halvings of a search's range
constexpr int kSteps = 30;             ///< maximum number of steps to find a section
constexpr double kSamePlace = 1e-12;   ///< tolerance for finding a section, as a fraction of the cutter's radius
constexpr double kNearby = 1e-4;       ///< distance behind the edge, as a fraction of the cutter's radius
constexpr double kFarthestSine = 0.9;  ///< largest sine of the angle around the rim at which the blank is touched
constexpr int kPlacesOfWidth = 32;     ///< intervals of the rim's width for finding the first contact

double handOf(const ConicalCutter& cutter) { return cutter.cone().cut == CutDirection::kLeftHand ? -1 : 1; }

[[noreturn]] void refuse(const char* name, double value, const char* unit, const std::string& allowed) {
  throw std::invalid_argument(format("%s = %g%s; allowed: %s", name, value, unit, allowed.c_str()));
}

/// The maximum of a function that rises to it and then falls.
template <typename Function>
double maximum(double from, double to, const Function& f) {
  constexpr double golden = 0.6180339887498949;
  double low = to - golden * (to - from), high = from + golden * (to - from);
  double at_low = f(low), at_high = f(high);
  for (int i = 0; i < kHalvings; ++i) {
    if (at_low > at_high) {
      to = high, high = low, at_high = at_low;
      low = to - golden * (to - from), at_low = f(low);
    } else {
      from = low, low = high, at_low = at_high;
      high = from + golden * (to - from), at_high = f(high);
    }
  }
  return std::max(at_low, at_high);
}

/// The machine angle of the relief's start, and the rim's normal there.
struct Contact {
  double phi, x, y, z;
};

Contact contactOf(const ReliefStart& start, double tan_cone, double tan_spiral, double swivel) {
  const double cone = start.radius_part * tan_cone, spiral = start.radius_part * tan_spiral;
  const double sine = -std::tan(swivel) * (cone * std::cos(start.clearance) + spiral * std::sin(start.clearance));
  if (!(std::abs(sine) < 1)) {
    refuse("setup.swivel", swivel / units::kDegree, " deg", "less, for the clearance and the spiral angle");
  }
  const double phi = std::asin(sine) - start.clearance;
  const double t_y = cone * std::cos(phi) - spiral * std::sin(phi), t_z = cone * std::sin(phi) + spiral * std::cos(phi);
  const double x = -t_y * std::cos(swivel), y = t_z * std::sin(swivel) + std::cos(swivel), z = -t_y * std::sin(swivel);
  const double length = std::sqrt(x * x + y * y + z * z);
  if (!(y > 0)) refuse("setup.swivel", swivel / units::kDegree, " deg", "one that does not turn the rim away");
  return {phi, x / length, y / length, z / length};
}

/// The linear relation of the height and the contact on the rim: height = at_middle - contact * per_contact.
struct HeightLaw {
  double at_middle, per_contact;
};

HeightLaw heightLaw(const Contact& c, const ReliefStart& start, double radius, double tan_cone, double wheel_radius,
                    double swivel) {
  const double rise = start.radius_part * tan_cone * std::sin(c.phi);  // dZ/dX
  return {start.radius_part * radius * std::sin(c.phi) + wheel_radius * (c.z - rise * c.x),
          std::cos(swivel) + rise * std::sin(swivel)};
}

ConicalCutter withRake(Cone cone, double sine) {
  cone.rake_angle = std::asin(sine);
  return ConicalCutter(cone);
}

}  // namespace

ReliefPath::ReliefPath(const ConicalCutter& cutter, const ReliefStart& start, const ReliefWheel& wheel)
    : start_(start),
      radius_(cutter.cone().end_diameter / 2),
      tan_cone_(cutter.tanCone()),
      tan_spiral_(handOf(cutter) * cutter.tanSpiral()),
      wheel_radius_(wheel.nominal_radius - wheel.wear),
      half_width_(wheel.width / 2),
      sin_(std::sin(handOf(cutter) * wheel.swivel)),
      cos_(std::cos(wheel.swivel)),
      rim_from_(wheel.corner_radius[handOf(cutter) > 0 ? 0 : 1] - half_width_),
      rim_to_(half_width_ - wheel.corner_radius[handOf(cutter) > 0 ? 1 : 0]),
      path_cutter_(cutter) {
  const double hand = handOf(cutter), swivel = hand * wheel.swivel;
  const Contact c = contactOf(start, tan_cone_, tan_spiral_, swivel);
  phi_ = c.phi, normal_x_ = c.x, normal_y_ = c.y, normal_z_ = c.z;
  const HeightLaw law = heightLaw(c, start, radius_, tan_cone_, wheel_radius_, swivel);
  contact_ = (law.at_middle - hand * wheel.height) / law.per_contact;
  if (!(contact_ >= rim_from_ && contact_ <= rim_to_)) {
    const auto height = [&](double contact) {
      return hand * (law.at_middle - contact * law.per_contact) / units::kMillimetre;
    };
    const auto [low, high] = std::minmax({height(rim_from_), height(rim_to_)});
    refuse("setup.height", wheel.height / units::kMillimetre, " mm",
           format("%g to %g mm, with the edge on the wheel's rim", low, high));
  }
  path_cutter_ = withRake(cutter.cone(), start.radius_part * std::sin(phi_));
  x_shift_ = wheel_radius_ * normal_x_ + contact_ * sin_;
  taper_ = tan_cone_ * (start.radius_part * std::cos(phi_) - 1);
  const double p_y = start.radius_part * std::cos(phi_) * (radius_ - x_shift_ * tan_cone_);
  y_ = p_y + wheel_radius_ * normal_y_ - radius_ - wheel.nominal_radius;
  a_ = hand * (start.behind - phi_);
  const double length = cutter.cone().flute_length;
  side_ = surfaceOf(0, kNearby * radius_).behind > start.behind ? 1 : -1;
  // If the end of the rim forms no surface (NaN), no overtravel is needed.
  const double end = side_ * half_width_ - contact_;
  beyond_end_ = std::fmax(0.0, -formedAt(0, end));
  beyond_shank_ = std::fmax(0.0, formedAt(length, end) - length);
}

double ReliefPath::depth() const noexcept {
  return std::max(touchDepth(-beyond_end_), touchDepth(path_cutter_.cone().flute_length + beyond_shank_));
}

double ReliefPath::heightFor(const ConicalCutter& cutter, const ReliefStart& start, const ReliefWheel& wheel,
                             double contact) {
  const double hand = handOf(cutter), swivel = hand * wheel.swivel;
  const Contact c = contactOf(start, cutter.tanCone(), hand * cutter.tanSpiral(), swivel);
  const HeightLaw law =
      heightLaw(c, start, cutter.cone().end_diameter / 2, cutter.tanCone(), wheel.nominal_radius - wheel.wear, swivel);
  return hand * (law.at_middle - contact * law.per_contact);
}

double ReliefPath::heightForReach(const ConicalCutter& cutter, const ReliefStart& start, ReliefWheel wheel,
                                  double reach) {
  wheel.height = heightFor(cutter, start, wheel, 0);
  const auto [lower, upper] = wheel.corner_radius;
  wheel.corner_radius = {};
  const ReliefPath amid(cutter, start, wheel);
  // The corners change sides in the mirror.
  const double end = amid.half_width_ - (amid.side_ * handOf(cutter) > 0 ? upper : lower);
  return heightFor(cutter, start, wheel, amid.side_ * (end - reach));
}

ReliefPath::Point ReliefPath::contactPoint(double s, double w) const noexcept {
  const double rho = start_.radius_part, radius = radius_ + s * tan_cone_;
  const double p_y = rho * radius * std::cos(phi_), p_z = rho * radius * std::sin(phi_);
  // The centre of the wheel's disc at w.
  const double x = s + wheel_radius_ * normal_x_ - w * sin_;
  const double y = p_y + wheel_radius_ * normal_y_, z = p_z + wheel_radius_ * normal_z_ + w * cos_;
  // The motion of that centre relative to the cutter, by s. The normal n = cos y + sin v is perpendicular to it, with y
  // and v = (cos swivel, 0, sin swivel) in the disc's plane. The rotation's contribution from the centre to the rim is
  // perpendicular to n.
  const double turn = tan_spiral_ / radius;
  const double v_y = rho * tan_cone_ * std::cos(phi_) - turn * z;
  const double v_z = rho * tan_cone_ * std::sin(phi_) + turn * y;
  const double in_plane = cos_ + v_z * sin_;
  const double length = std::hypot(v_y, in_plane);
  const double cosine = std::abs(in_plane) / length, sine = (in_plane > 0 ? -v_y : v_y) / length;
  const double n_x = sine * cos_, n_y = cosine, n_z = sine * sin_;
  return {x - wheel_radius_ * n_x, y - wheel_radius_ * n_y, z - wheel_radius_ * n_z, n_y, n_z};
}

double ReliefPath::formedAt(double x, double w) const noexcept {
  const auto off = [&](double s) { return contactPoint(s, w).x - x; };
  double before = x + w * sin_, off_before = off(before), s = before - off_before;
  for (int i = 0; i < kSteps; ++i) {
    const double here = off(s);
    if (!(radius_ + s * tan_cone_ > 0)) break;
    if (std::abs(here) <= kSamePlace * radius_) return s;
    const double next = s - here * (s - before) / (here - off_before);
    before = s, off_before = here, s = next;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

ReliefPath::Place ReliefPath::surface(double x, double along) const noexcept { return surfaceOf(x, side_ * along); }

ReliefPath::Place ReliefPath::surfaceOf(double x, double w) const noexcept {
  const double s = formedAt(x, w);
  const Point p = contactPoint(s, w);
  const double angle = std::atan2(p.z, p.y);
  // The edge in this section, which turns on from s to x.
  const double t = (x - s) * tan_cone_ / (radius_ + s * tan_cone_);
  const double ratio = t == 0 ? 1 : std::log1p(t) / t;
  const double turned = tan_spiral_ * (x - s) / (radius_ + s * tan_cone_) * ratio;
  return {std::hypot(p.y, p.z), angle - phi_ + start_.behind - turned, std::atan2(p.normal_z, p.normal_y) - angle};
}

ReliefPath::Place ReliefPath::surfaceAt(double x, double width) const noexcept {
  const Place from = surface(x, 0);
  const auto distance = [&](const Place& place) {
    return std::hypot(place.radius * std::cos(place.behind - from.behind) - from.radius,
                      place.radius * std::sin(place.behind - from.behind));
  };
  double low = 0, high = reach();
  if (!(distance(surface(x, high)) >= width)) return {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (distance(surface(x, middle)) < width ? low : high) = middle;
  }
  return surface(x, low);
}

double ReliefPath::touchDepth(double s) const noexcept {
  const double rho = start_.radius_part, at = radius_ + s * tan_cone_;
  const double x = s + wheel_radius_ * normal_x_ + contact_ * sin_;
  const double y = rho * at * std::cos(phi_) + wheel_radius_ * normal_y_;
  const double z = rho * at * std::sin(phi_) + wheel_radius_ * normal_z_ - contact_ * cos_;
  // The depth of a point of the rim below the blank's surface.
  const auto below = [&](double w, double sine) {
    const double p_x = x - w * sin_ + wheel_radius_ * sine * cos_;
    const double p_z = z + w * cos_ + wheel_radius_ * sine * sin_;
    const double p_y = y - wheel_radius_ * std::sqrt(1 - sine * sine);
    const double blank = radius_ + p_x * tan_cone_;
    const double square = blank > 0 ? blank * blank - p_z * p_z : 0;
    // Beside the blank, the value falls with the distance from it, to guide the search.
    return square > 0 ? std::sqrt(square) - p_y : -std::abs(p_z) - p_y;
  };
  const auto of_place = [&](double w) {
    return maximum(-kFarthestSine, kFarthestSine, [&](double sine) { return below(w, sine); });
  };
  const double step = 2 * half_width_ / kPlacesOfWidth;
  int best = 0;
  double most = of_place(-half_width_);
  for (int i = 1; i <= kPlacesOfWidth; ++i) {
    const double value = of_place(-half_width_ + i * step);
    if (value > most) best = i, most = value;
  }
  const double from = -half_width_ + std::max(best - 1, 0) * step;
  const double to = -half_width_ + std::min(best + 1, kPlacesOfWidth) * step;
  return std::max({most, maximum(from, to, of_place), 0.0});
}

}  // namespace grinder
