#include "flute_grinder/tool/wheel_profile.h"

#include "flute_grinder/base/require.h"
#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

constexpr double kShortfall = 1e-6;  ///< relative amount by which the largest radius may be too small

}  // namespace

WheelProfile::WheelProfile(std::vector<ProfilePoint> corners, const std::array<double, 2>& corner_radii)
    : corners_(std::move(corners)), corner_radii_(corner_radii) {
  require(corners_.size() >= 2, "wheel.points", static_cast<double>(corners_.size()), "two or more");
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    require(corners_[i].radius > 0 && std::isfinite(corners_[i].radius), "wheel.radius", corners_[i].radius,
            "positive and finite", " m");
    require(std::isfinite(corners_[i].w) && (i == 0 || corners_[i].w > corners_[i - 1].w), "wheel.w", corners_[i].w,
            "finite, ascending", " m");
  }
  fillets_ = {fillet(false, corner_radii[0]), fillet(true, corner_radii[1])};
  require(fillets_[0].to <= fillets_[1].from, "wheel.corner_radius", std::max(corner_radii[0], corner_radii[1]),
          "small enough for both corners to fit", " m");
  findMax();
}

WheelProfile WheelProfile::straight(double diameter, double width, const std::array<double, 2>& corner_radii) {
  return WheelProfile({{-width / 2, diameter / 2}, {width / 2, diameter / 2}}, corner_radii);
}

WheelProfile WheelProfile::angled(double diameter, double width, double angle,
                                  const std::array<double, 2>& corner_radii) {
  const double drop = width * std::tan(std::abs(angle));
  const double lower = diameter / 2 - (angle > 0 ? drop : 0);
  const double upper = diameter / 2 - (angle > 0 ? 0 : drop);
  return WheelProfile({{-width / 2, lower}, {width / 2, upper}}, corner_radii).withDiameter(diameter);
}

WheelProfile WheelProfile::fullRadius(double diameter, double width) {
  return straight(diameter, width, {width / 2, width / 2});
}

double WheelProfile::Fillet::at(double w_here) const noexcept {
  const double across = w_here - w;
  return radius + std::sqrt(std::max(0.0, size * size - across * across));
}

double WheelProfile::Fillet::slopeAt(double w_here) const noexcept {
  const double across = w_here - w;
  // At the face, where the circle touches it, the slope is infinite.
  return -across / std::sqrt(std::max(1e-12 * size * size, size * size - across * across));
}

std::size_t WheelProfile::lineAt(double w) const noexcept {
  std::size_t i = 1;
  while (i + 1 < corners_.size() && w > corners_[i].w) ++i;
  return i;
}

double WheelProfile::radius(double w) const noexcept {
  for (const Fillet& f : fillets_) {
    if (f.covers(w)) return f.at(w);
  }
  const std::size_t i = lineAt(w);
  const ProfilePoint& a = corners_[i - 1];
  const ProfilePoint& b = corners_[i];
  return a.radius + (w - a.w) / (b.w - a.w) * (b.radius - a.radius);
}

double WheelProfile::slope(double w) const noexcept {
  for (const Fillet& f : fillets_) {
    if (f.covers(w)) return f.slopeAt(w);
  }
  const std::size_t i = lineAt(w);
  return (corners_[i].radius - corners_[i - 1].radius) / (corners_[i].w - corners_[i - 1].w);
}

WheelProfile::Fillet WheelProfile::fillet(bool upper, double size) const {
  require(size >= 0 && std::isfinite(size), "wheel.corner_radius", size, "0 or more", " m");
  const ProfilePoint& corner = upper ? corners_.back() : corners_.front();
  const ProfilePoint& next = upper ? corners_[corners_.size() - 2] : corners_[1];
  if (size == 0) return {corner.w, corner.w, corner.w, corner.radius, 0};
  // The circle touches the face, and the profile's line from below.
  const double inward = upper ? -1 : 1;
  const double slope = (next.radius - corner.radius) / (next.w - corner.w);
  const double w = corner.w + inward * size;
  const double radius = corner.radius + slope * (w - corner.w) - size * std::sqrt(1 + slope * slope);
  const double touch = w - size * slope / std::sqrt(1 + slope * slope);
  require(radius > 0, "wheel.corner_radius", size, "less than the wheel's radius allows", " m");
  require(upper ? touch >= next.w : touch <= next.w, "wheel.corner_radius", size, "within the profile's first line",
          " m");
  return upper ? Fillet{touch, corner.w + 1, w, radius, size} : Fillet{corner.w - 1, touch, w, radius, size};
}

std::vector<ProfilePoint> WheelProfile::outline(double error) const {
  std::vector<ProfilePoint> outline;
  addEnd(false, error, outline);
  outline.insert(outline.end(), corners_.begin() + 1, corners_.end() - 1);
  addEnd(true, error, outline);
  return outline;
}

/// Adds the corner at a face, or those of a polygon about its circle.
void WheelProfile::addEnd(bool upper, double error, std::vector<ProfilePoint>& outline) const {
  const Fillet& circle = fillets_[upper ? 1 : 0];
  const ProfilePoint& corner = upper ? corners_.back() : corners_.front();
  if (circle.size == 0) {
    outline.push_back(corner);
    return;
  }
  // The directions of the normal where the circle begins and ends, from the radius toward the upper face.
  const ProfilePoint& next = upper ? corners_[corners_.size() - 2] : corners_[1];
  const double line = std::atan2(-(next.radius - corner.radius) / (next.w - corner.w), 1);
  const double from = upper ? line : -units::kPi / 2, to = upper ? units::kPi / 2 : line;
  const double parts = std::ceil((to - from) / std::sqrt(8 * error / circle.size));
  const double step = (to - from) / parts, size = circle.size / std::cos(step / 2);
  for (double part = 0; part < parts; ++part) {
    const double at = from + (part + 0.5) * step;
    outline.push_back({circle.w + size * std::sin(at), circle.radius + size * std::cos(at)});
  }
}

void WheelProfile::findMax() {
  std::vector<double> places;  // between two of them there is a line, or a circle that rises or falls
  for (const ProfilePoint& corner : corners_) places.push_back(corner.w);
  for (const Fillet& f : fillets_) {
    if (f.size > 0) places.push_back(std::clamp(f.w, lowerFace(), upperFace()));
  }
  std::sort(places.begin(), places.end());
  for (const double w : places) max_radius_ = std::max(max_radius_, radius(w));
  const auto is_max = [&](double w) { return radius(w) >= max_radius_ * (1 - kShortfall); };
  const auto last = std::find_if(places.rbegin(), places.rend(), is_max);
  const auto before = std::find_if_not(last, places.rend(), is_max);
  max_place_ = {*std::prev(before), *last};
}

WheelProfile WheelProfile::mirrored() const {
  std::vector<ProfilePoint> corners(corners_.rbegin(), corners_.rend());
  for (ProfilePoint& corner : corners) corner.w = -corner.w;
  return WheelProfile(std::move(corners), {corner_radii_[1], corner_radii_[0]});
}

WheelProfile WheelProfile::worn(double wear) const {
  std::vector<ProfilePoint> corners = corners_;
  for (ProfilePoint& corner : corners) corner.radius -= wear;
  return WheelProfile(std::move(corners), corner_radii_);
}

WheelProfile WheelProfile::withDiameter(double diameter) const { return worn(max_radius_ - diameter / 2); }

std::optional<WheelProfile> WheelProfile::withWidth(double width) const {
  const bool is_straight = corners_.size() == 2 && corners_[0].radius == corners_[1].radius;
  if (!is_straight || !(corner_radii_[0] + corner_radii_[1] <= width)) return std::nullopt;
  return straight(2 * max_radius_, width, corner_radii_);
}

}  // namespace grinder
