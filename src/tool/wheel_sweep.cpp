#include "flute_grinder/tool/wheel_sweep.h"

#include "flute_grinder/base/require.h"
#include "flute_grinder/base/units.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace grinder {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNotReached = -kInfinite;
constexpr int kMinPoses = 32, kMaxPoses = 512;  ///< poses of a window, from which an extremum is refined
constexpr double kPoseTurn = 0.1;  ///< turn of the cutter between two poses; or rise of the wheel, per cutter radius
constexpr int kAnglesPerPose = 8;  ///< angles from which the wheel's deepest place on a circle is refined
constexpr std::uintmax_t kMaxPoseSteps = 60;
constexpr int kPoseHalvings = 30;      ///< halvings of a step between poses, to reach a circle near the floor
constexpr int kDiscs = 16;             ///< discs of the wheel, from which its minimum radius is refined
constexpr double kCorner = 1e-9;       ///< distance from a corner of the profile that counts as the corner [m]
constexpr double kAside = 0.01;        ///< distance beside a pose at which an end is tried, per step between poses
constexpr double kEndStep = 1e-10;     ///< step of Newton's method after which the next is lost in rounding [rad]
constexpr double kSameAngle = 1e-12;   ///< angle by which a longer stroke must move an end to count as farther [rad]
constexpr double kNearestApex = 1e-3;  ///< distance from the apex, per end radius, where a cone turns endlessly
constexpr double kSameEnd = 1e-7;      ///< precision with which two searches find the same end [rad]

void requireFinite(const char* name, double value) { require(std::isfinite(value), name, value, "a finite number"); }

}  // namespace

PathDeviation between(const PathDeviation& a, const PathDeviation& b, double part) noexcept {
  return {a.y + part * (b.y - a.y), a.z + part * (b.z - a.z), a.a + part * (b.a - a.a), a.x + part * (b.x - a.x)};
}

PathDeviation deviationAt(const std::vector<PathDeviation>& all, const Range& range, double x) noexcept {
  const double length = range.to - range.from;
  const double at = length > 0 ? std::clamp((x - range.from) / length, 0.0, 1.0) : 0;
  const double place = at * static_cast<double>(all.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  return i + 1 < all.size() ? between(all[i], all[i + 1], place - static_cast<double>(i)) : all.back();
}

WheelSweep::WheelSweep(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius,
                       const WheelSetup& setup, const GrindStroke& stroke)
    : curve_(cutter, setup.x_shift),
      wheel_(wheel),
      stroke_(stroke),
      height_(setup.height),
      sin_(std::sin(setup.swivel)),
      cos_(std::cos(setup.swivel)),
      radius_(cutter.cone().end_diameter / 2),
      centre_(radius_ + nominal_radius + stroke.y),
      tan_cone_(cutter.tanCone()),
      y_per_x_(tan_cone_ + stroke.y_per_x),
      z_per_x_(tan_cone_ * cutter.zPerY()) {
  require(std::abs(setup.swivel) < units::kPi / 2, "setup.swivel", setup.swivel, "within (-pi/2, pi/2)", " rad");
  requireFinite("setup.height", setup.height);
  require(cutter.radius(-setup.x_shift) > 0, "setup.x_shift", setup.x_shift, "less than the way to the apex", " m");
  for (const double value : {stroke.from, stroke.to, stroke.y, stroke.y_per_x, stroke.a})
    requireFinite("stroke", value);
  for (const PathDeviation& d : stroke.deviations) {
    for (const double value : {d.y, d.z, d.a}) requireFinite("stroke's deviation", value);
  }
  apex_ = -1 / curve_.b();
  const auto lower = [](const PathDeviation& a, const PathDeviation& b) { return a.y < b.y; };
  const auto deepest = std::min_element(stroke.deviations.begin(), stroke.deviations.end(), lower);
  if (deepest != stroke.deviations.end()) deepest_deviation_ = deepest->y;
  // A spline stays between its coefficients.
  const auto first = stroke.z_correction.coefficients.begin();
  if (const int count = stroke.z_correction.coefficientCount(); count > 0) {
    const auto [low, high] = std::minmax_element(first, first + count);
    z_off_ = {*low, *high};
  }
  const auto below = [](const PathDeviation& a, const PathDeviation& b) { return a.z < b.z; };
  const auto [low, high] = std::minmax_element(stroke.deviations.begin(), stroke.deviations.end(), below);
  if (low != stroke.deviations.end()) z_off_ = {z_off_.from + low->z, z_off_.to + high->z};
}

PathDeviation WheelSweep::deviation(double axis_x) const noexcept {
  if (stroke_.deviations.empty()) return {};
  const auto [from, to] = std::minmax(stroke_.from, stroke_.to);
  return deviationAt(stroke_.deviations, {from, to}, axis_x);
}

PathDeviation WheelSweep::deviationSlope(double axis_x) const noexcept {
  const std::size_t count = stroke_.deviations.size();
  if (count < 2) return {};
  const double step = std::abs(stroke_.to - stroke_.from) / static_cast<double>(count - 1);
  if (!(step > 0)) return {};
  const PathDeviation before = deviation(axis_x - step), after = deviation(axis_x + step);
  const double span = 2 * step;
  return {(after.y - before.y) / span, (after.z - before.z) / span, (after.a - before.a) / span};
}

WheelSweep::Pose WheelSweep::pose(double x, double axis_x) const noexcept {
  const PathDeviation off = deviation(axis_x);
  const double z = height_ + axis_x * z_per_x_ + stroke_.z_correction.at(axis_x).z + off.z;
  return {axis_x, x - axis_x, centre_ + axis_x * y_per_x_ + off.y, z, a(axis_x) + off.a};
}

double WheelSweep::lowestPoint(double axis_x) const noexcept {
  return centre_ + axis_x * y_per_x_ + deepest_deviation_ - wheel_.maxRadius();
}

WheelSweep::FromWheel WheelSweep::fromWheel(const Pose& p, double y, double z) const noexcept {
  const double dy = y - p.y, dz = z - p.z;
  const double w = dz * cos_ - p.dx * sin_;
  const double t = dz * sin_ + p.dx * cos_;
  const double from_axis = std::sqrt(dy * dy + t * t);
  return {from_axis, from_axis - wheel_.radius(std::clamp(w, wheel_.lowerFace(), wheel_.upperFace()))};
}

WheelSweep::Window WheelSweep::reach(double x, double r) const noexcept {
  const double width = std::max(std::abs(wheel_.lowerFace()), std::abs(wheel_.upperFace())) * std::abs(sin_);
  const double radius = wheel_.maxRadius();
  // The range in which the wheel's circle, seen from the side and moved by the width either way, meets the height r: on
  // a cone its centre rises with X.
  const double above = centre_ + x * y_per_x_ + deepest_deviation_ - r;
  const double stretch = 1 / (cos_ * cos_);
  const double a = y_per_x_ * y_per_x_ + stretch;
  const auto end = [&](double side) {
    const double b = y_per_x_ * above - side * width * stretch;
    const double square = b * b - a * (above * above + width * width * stretch - radius * radius);
    return side * std::max(width, square > 0 ? (-side * b + std::sqrt(square)) / a : 0);
  };
  const Window abreast = betweenFaces(x, r);
  return {std::max(x + end(-1), abreast.from), std::min(x + end(1), abreast.to)};
}

WheelSweep::Window WheelSweep::betweenFaces(double x, double r) const noexcept {
  // In a section the faces pass the axis at heights that are linear along the stroke.
  const double rise = z_per_x_ - sin_ / cos_;
  const double at_start = height_ + x * sin_ / cos_;
  const double min = -r - (at_start + wheel_.upperFace() / cos_ + z_off_.to);
  const double max = r - (at_start + wheel_.lowerFace() / cos_ + z_off_.from);
  if (rise == 0) return min <= 0 && max >= 0 ? Window{-kInfinite, kInfinite} : Window{kInfinite, -kInfinite};
  return {std::min(min / rise, max / rise), std::max(min / rise, max / rise)};
}

int WheelSweep::posesOf(double x, const Window& w) const noexcept {
  const double turn = std::abs(curve_.delta(w.from, w.to - w.from));
  const double rise = std::abs(z_per_x_ - sin_ / cos_) * (w.to - w.from) / (radius_ + x * tan_cone_);
  const double poses = std::ceil(std::max(turn, rise) / kPoseTurn);
  return poses < kMaxPoses ? std::max(kMinPoses, static_cast<int>(poses)) : kMaxPoses;
}

std::optional<WheelSweep::Window> WheelSweep::window(double x, double r) const noexcept {
  const Window all = reach(x, r);
  const Window w{std::max(std::min(stroke_.from, stroke_.to), all.from),
                 std::min(std::max(stroke_.from, stroke_.to), all.to)};
  if (!(w.from < w.to) || std::min(lowestPoint(w.from), lowestPoint(w.to)) >= r) return std::nullopt;
  return w;
}

std::optional<double> WheelSweep::endAt(const Pose& p, double r, bool high) const {
  const double lowest = p.y - wheel_.maxRadius();
  if (lowest >= r) return std::nullopt;
  // The angles at which the circle is between the wheel's faces and not below its lowest point.
  const double cos_open = std::max(0.0, lowest / r), sin_open = std::sqrt(1 - cos_open * cos_open);
  const auto sin_at_face = [&](double w) { return (p.z + (w + p.dx * sin_) / cos_) / r; };
  const double sin_min = sin_at_face(wheel_.lowerFace()), sin_max = sin_at_face(wheel_.upperFace());
  if (!(std::max(-sin_open, sin_min) < std::min(sin_open, sin_max))) return std::nullopt;
  const auto lowEnd = [&] { return -sin_open < sin_min ? std::asin(sin_min) : -std::acos(cos_open); };
  const auto highEnd = [&] { return sin_max < sin_open ? std::asin(sin_max) : std::acos(cos_open); };

  // From the end inward to the first point in the wheel.
  const double end = high ? highEnd() : lowEnd();
  const double sin_end = high ? std::min(sin_open, sin_max) : std::max(-sin_open, sin_min);
  double y = r * std::sqrt(1 - sin_end * sin_end), z = r * sin_end;
  double closest = kInfinite;  // distance to the spindle's axis
  const auto placeAt = [&](double theta) {
    const FromWheel from = fromWheel(p, y, z);
    closest = std::min(closest, from.spindle);
    return PlaceOnCircle{theta, from.outside};
  };
  const PlaceOnCircle first = placeAt(end);
  if (first.outside <= 0) return end;
  const double min = high ? lowEnd() : end, max = high ? end : highEnd();
  const double step = ((high ? min : max) - end) / kAnglesPerPose;
  const double cos_step = std::cos(step), sin_step = std::sin(step);
  PlaceOnCircle before = first, nearest = first;
  for (int i = 1; i <= kAnglesPerPose; ++i) {
    std::tie(y, z) = std::make_tuple(y * cos_step - z * sin_step, z * cos_step + y * sin_step);
    const PlaceOnCircle here = placeAt(end + i * step);
    if (here.outside <= 0) return endBetween(p, r, here, before);
    if (here.outside < nearest.outside) nearest = here;
    before = here;
  }
  // The distance from the axis changes by at most the distance along the circle.
  if (closest > wheel_.maxRadius() + r * std::abs(step) / 2) return std::nullopt;
  const auto f = [&](double theta) { return outside(p, r * std::cos(theta), r * std::sin(theta)); };
  std::uintmax_t steps = kMaxPoseSteps;
  const double way = std::abs(step);
  const auto [theta, value] = boost::math::tools::brent_find_minima(f, std::max(min, nearest.theta - way),
                                                                    std::min(max, nearest.theta + way), 26, steps);
  if (!(value <= 0)) return std::nullopt;
  return endBetween(p, r, {theta, value}, first);
}

double WheelSweep::endBetween(const Pose& p, double r, PlaceOnCircle in, PlaceOnCircle out) const noexcept {
  // Newton's method, kept between the two places.
  double theta = in.theta + (out.theta - in.theta) * in.outside / (in.outside - out.outside);
  for (std::uintmax_t i = 0; i < kMaxPoseSteps; ++i) {
    const double y = r * std::cos(theta), z = r * std::sin(theta);
    const double value = outside(p, y, z);
    (value <= 0 ? in : out).theta = theta;
    const double dy = y - p.y, dz = z - p.z;
    const double w = std::clamp(dz * cos_ - p.dx * sin_, wheel_.lowerFace(), wheel_.upperFace());
    const double t = dz * sin_ + p.dx * cos_;
    const double slope = (t * y * sin_ - dy * z) / std::sqrt(dy * dy + t * t) - wheel_.slope(w) * y * cos_;
    double next = theta - value / slope;
    if (!((next - in.theta) * (next - out.theta) <= 0)) next = (in.theta + out.theta) / 2;
    if (std::abs(next - theta) < kEndStep) return next;
    theta = next;
  }
  return theta;
}

double WheelSweep::endOver(double x, double axis_x, double r, bool high) const {
  const Pose p = pose(x, axis_x);
  const auto end = endAt(p, r, high);
  if (!end) return kNotReached;
  return high ? *end + p.a : -(*end + p.a);
}

WheelSweep::Extremum WheelSweep::extremum(double x, double r, const Window& window, bool high) const {
  // The largest end of the arcs, or the smallest through its negative.
  const auto end = [&](double axis_x) { return endOver(x, axis_x, r, high); };
  const int poses = posesOf(x, window);
  std::array<double, kMaxPoses + 1> value;
  const double step = (window.to - window.from) / poses;
  value[0] = end(window.from);
  for (int i = 1; i <= poses; ++i) value[static_cast<std::size_t>(i)] = end(window.from + i * step);
  const auto first = std::max_element(value.begin(), value.begin() + poses + 1);
  double best = *first;
  double best_at = static_cast<double>(first - value.begin());
  const auto at = [&](int i) { return i < 0 || i > poses ? kNotReached : value[static_cast<std::size_t>(i)]; };
  // In steps, since the search ends at a fixed fraction of its variable.
  const auto search = [&](int i, int side) {
    const auto lost = [&](double along) {
      const double e = end(window.from + (i + along) * step);
      return e == kNotReached ? std::numeric_limits<double>::max() : -e;
    };
    std::uintmax_t steps = kMaxPoseSteps;
    const auto peak =
        boost::math::tools::brent_find_minima(lost, std::min(side, 0) * 1.0, std::max(side, 0) * 1.0, 26, steps);
    if (-peak.second > best) best = -peak.second, best_at = i + peak.first;
  };
  for (int i = 0; i <= poses; ++i) {
    if (at(i) == kNotReached || (at(i) == at(i - 1) && at(i) == at(i + 1))) continue;
    const auto rises = [&](int side) {
      return i + side >= 0 && i + side <= poses && end(window.from + (i + side * kAside) * step) > at(i);
    };
    if (at(i) >= at(i - 1) && at(i) >= at(i + 1)) {
      // Any peak among the poses may be highest on either side of it.
      const bool before = rises(-1), after = rises(1);
      if (i > 0 && (before || !after)) search(i, -1);
      if (i < poses && (after || !before)) search(i, 1);
      continue;
    }
    // A peak may also lie between the last pose that reaches the circle and the next one.
    for (const int side : {-1, 1}) {
      if (at(i + side) == kNotReached && rises(side)) search(i, side);
    }
  }
  double axis_x = window.from + best_at * step;
  // A straight flute's wall is formed all along the stroke; the section's own X is then taken.
  if (const double here = std::clamp(x, window.from, window.to); end(here) >= best) axis_x = here;
  return {best, axis_x};
}

WheelSweep::Window WheelSweep::openReach(double x, double r) const noexcept {
  const Window all = reach(x, r);
  const double nearest = (1 - kNearestApex) * apex_;
  return {apex_ < 0 ? std::max(all.from, nearest) : all.from, apex_ > 0 ? std::min(all.to, nearest) : all.to};
}

bool WheelSweep::isComplete(double x, double r, double angle, double axis_x, bool high) const {
  const double end = high ? angle : -angle;
  const Window all = openReach(x, r);
  const auto farther = [&](double from, double to) {
    return from < to && extremum(x, r, {from, to}, high).value > end + kSameAngle;
  };
  const double from = std::min(stroke_.from, stroke_.to), to = std::max(stroke_.from, stroke_.to);
  const bool before = farther(all.from, std::min(all.to, from)), after = farther(std::max(all.from, to), all.to);
  if (apex_ < 0 ? after : before) return false;
  const bool at_end = std::abs(axis_x - (apex_ < 0 ? from : to)) < kCorner;
  if (!before && !after && !at_end) return true;
  const auto spoiled = spoiling(x, r, high);
  return spoiled ? std::abs(end - spoiled->end.value) < kSameEnd : !before && !after;
}

std::optional<WheelSweep::Spoiling> WheelSweep::spoiling(double x, double r, bool high) const {
  const Window all = openReach(x, r);
  const double nearest = apex_ < 0 ? all.from : all.to, farthest = apex_ < 0 ? all.to : all.from;
  if (!std::isfinite(apex_) || nearest != (1 - kNearestApex) * apex_ || !(all.from < all.to)) return std::nullopt;
  // From the apex inward, the end falls until the flute's own poses begin.
  const auto end = [&](double axis_x) { return endOver(x, axis_x, r, high); };
  const int poses = posesOf(x, all);
  const double step = (farthest - nearest) / poses;
  const double worst = end(nearest);
  double lowest = worst, valley = nearest;
  for (int i = 1; i <= poses; ++i) {
    const double value = end(nearest + i * step);
    if (!(value < lowest)) break;
    lowest = value, valley = nearest + i * step;
    if (value == kNotReached) break;
  }
  if (valley == nearest) return std::nullopt;
  const Extremum own = extremum(x, r, {std::min(valley, farthest), std::max(valley, farthest)}, high);
  if (own.value == kNotReached || !(worst > own.value)) return std::nullopt;
  double within = valley, beyond = nearest;
  for (int i = 0; i < kPoseHalvings; ++i) {
    const double middle = (within + beyond) / 2;
    (end(middle) > own.value ? beyond : within) = middle;
  }
  return Spoiling{within, own};
}

std::optional<double> WheelSweep::overcutStart(double x, double r) const {
  std::optional<double> first;
  for (const bool high : {false, true}) {
    const auto found = spoiling(x, r, high);
    if (found && (!first || std::abs(found->from - x) < std::abs(*first - x))) first = found->from;
  }
  return first;
}

template <typename Function>
WheelSweep::Minimum WheelSweep::minimum(double x, double max_height, const Function& f) const {
  // Along the stroke, f is convex for the disc of the wheel at w: one search finds its minimum.
  const auto of_disc = [&](double w) -> Minimum {
    const double radius = wheel_.radius(w);
    double from = std::max(std::min(stroke_.from, stroke_.to), x - (radius * cos_ - w * sin_));
    double to = std::min(std::max(stroke_.from, stroke_.to), x + (radius * cos_ + w * sin_));
    const double rise = z_per_x_ - sin_ / cos_;
    const double height = height_ + (w + x * sin_) / cos_;
    if (std::isfinite(max_height)) {
      if (rise == 0 && std::abs(height) > max_height) return {kInfinite, x};
      if (rise != 0) {
        const double one = (max_height - height) / rise, other = (-max_height - height) / rise;
        from = std::max(from, std::min(one, other));
        to = std::min(to, std::max(one, other));
      }
    }
    if (!(from <= to)) return {kInfinite, x};
    const auto along = [&](double axis_x) {
      const double t = (w * sin_ + x - axis_x) / cos_;
      const PathDeviation off = deviation(axis_x);
      const double y = centre_ + axis_x * y_per_x_ + off.y - std::sqrt(std::max(0.0, radius * radius - t * t));
      return f(y, height + axis_x * rise + stroke_.z_correction.at(axis_x).z + off.z);
    };
    std::uintmax_t steps = kMaxPoseSteps;
    const auto found = boost::math::tools::brent_find_minima(along, from, to, 26, steps);
    return {found.second, found.first};
  };
  const double step = (wheel_.upperFace() - wheel_.lowerFace()) / kDiscs;
  const auto at = [&](double i) { return of_disc(std::min(wheel_.lowerFace() + i * step, wheel_.upperFace())); };
  std::array<Minimum, kDiscs + 1> discs;
  for (int i = 0; i <= kDiscs; ++i) discs[static_cast<std::size_t>(i)] = at(i);
  Minimum best = discs[0];
  for (int i = 0; i <= kDiscs; ++i) {
    const auto here = static_cast<std::size_t>(i);
    if (discs[here].value < best.value) best = discs[here];
    if (i > 0 && discs[here].value > discs[here - 1].value) continue;
    if (i < kDiscs && discs[here].value > discs[here + 1].value) continue;
    std::uintmax_t steps = kMaxPoseSteps;
    const double from = std::max(0, i - 1), to = std::min(kDiscs, i + 1);
    const auto value = [&](double disc) { return at(disc).value; };
    const Minimum found = at(boost::math::tools::brent_find_minima(value, from, to, 26, steps).first);
    if (found.value < best.value) best = found;
  }
  return best;
}

WheelSweep::Minimum WheelSweep::minSquare(double x) const {
  const auto square = [](double y, double z) { return (y > 0 ? y * y : 0) + z * z; };
  return minimum(x, std::numeric_limits<double>::infinity(), square);
}

std::optional<WheelSweep::Window> WheelSweep::narrowWindow(double x, double r, double step) const {
  // Near the floor, circles are reached along less of the stroke than a step between poses.
  const Minimum lowest = minSquare(x);
  const auto reached = [&](double axis_x) { return endAt(pose(x, axis_x), r, true).has_value(); };
  if (!(lowest.value < r * r) || !reached(lowest.axis_x)) return std::nullopt;
  const auto end = [&](double outside) {
    double inside = lowest.axis_x;
    for (int i = 0; i < kPoseHalvings; ++i) {
      const double middle = (inside + outside) / 2;
      (reached(middle) ? inside : outside) = middle;
    }
    return inside;
  };
  return Window{end(std::max(lowest.axis_x - step, std::min(stroke_.from, stroke_.to))),
                end(std::min(lowest.axis_x + step, std::max(stroke_.from, stroke_.to)))};
}

WheelSweep::Extremum WheelSweep::anyExtremum(double x, double r, const Window& window, bool high) const {
  const Extremum found = extremum(x, r, window, high);
  if (found.value != kNotReached) return found;
  const auto narrow = narrowWindow(x, r, (window.to - window.from) / posesOf(x, window));
  return narrow ? extremum(x, r, *narrow, high) : found;
}

std::optional<Arc> WheelSweep::arc(double x, double r) const {
  const auto w = window(x, r);
  if (!w) return std::nullopt;
  const Extremum high = anyExtremum(x, r, *w, true);
  if (high.value == kNotReached) return std::nullopt;
  const Extremum low = anyExtremum(x, r, *w, false);
  return Arc{-low.value, high.value, low.axis_x, high.axis_x};
}

WheelSweep::Normal WheelSweep::normal(const Pose& p, double r, double theta, double w) const noexcept {
  const double y = r * std::cos(theta), z = r * std::sin(theta);
  const double dy = y - p.y, dz = z - p.z;
  const double t = dz * sin_ + p.dx * cos_;
  const double from_axis = std::sqrt(dy * dy + t * t);
  // The slope of a flat face, or of the profile.
  const bool upper = w > wheel_.upperFace(), lower = w < wheel_.lowerFace();
  const double axial = upper ? 1 : lower ? -1 : -wheel_.slope(w);
  const double radial = upper || lower ? 0 : 1 / from_axis;
  const double n_x = radial * t * cos_ - axial * sin_;
  const double n_y = radial * dy;
  const double n_z = radial * t * sin_ + axial * cos_;
  const PathDeviation off = deviationSlope(p.axis_x);
  const double tangential = (n_z * y - n_y * z) / r;
  return {n_x, (n_y * y + n_z * z) / r, tangential,
          n_x + n_y * (y_per_x_ + off.y) + n_z * (z_per_x_ + stroke_.z_correction.at(p.axis_x).first + off.z) +
              (curve_.slope(p.axis_x) + off.a) * r * tangential};
}

std::optional<Wall> WheelSweep::wall(double x, double r, bool high) const {
  const auto range = window(x, r);
  if (!range) return std::nullopt;
  const Extremum end = anyExtremum(x, r, *range, high);
  if (end.value == kNotReached) return std::nullopt;
  const double angle = high ? end.value : -end.value;
  const Pose p = pose(x, end.axis_x);
  const double theta = angle - p.a;
  const double w = std::clamp((r * std::sin(theta) - p.z) * cos_ - p.dx * sin_, wheel_.lowerFace(), wheel_.upperFace());

  // The wheel moves along its groove's wall. At a corner of the profile the normal may be any between the normals of
  // its two sides; the wall's normal is the one perpendicular to the wheel's motion.
  const bool on_face = outside(p, r * std::cos(theta), r * std::sin(theta)) < -kCorner;
  const double face = w + (2 * w > wheel_.lowerFace() + wheel_.upperFace() ? 1 : -1) * wheel_.maxRadius();
  const Normal below = normal(p, r, theta, on_face ? face : w - kCorner);
  const Normal above = normal(p, r, theta, on_face ? face : w + kCorner);
  const double difference = above.along_motion - below.along_motion;
  const double part = difference == 0 ? 0.5 : std::clamp(-below.along_motion / difference, 0.0, 1.0);
  const auto at_wall = [&](double Normal::*component) {
    return below.*component + part * (above.*component - below.*component);
  };
  const double per_angle = r * at_wall(&Normal::tangential);
  return Wall{angle, -at_wall(&Normal::radial) / per_angle, -at_wall(&Normal::axial) / per_angle, w, end.axis_x};
}

double WheelSweep::minRadius(double x, double blank_radius) const {
  const double radius = std::sqrt(minSquare(x).value);
  return radius < blank_radius ? radius : std::numeric_limits<double>::infinity();
}

double WheelSweep::deeperFor(double x, double radius) const {
  const auto deeper = [&](double y, double z) { return y - std::sqrt(std::max(0.0, radius * radius - z * z)); };
  return minimum(x, radius, deeper).value;
}

}  // namespace grinder
