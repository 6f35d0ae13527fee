#include "tool/face_sweep.h"

#include "flute_grinder/base/units.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace grinder {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kNothing{kInfinity, -kInfinity};
constexpr int kRootSteps = 60, kRootBits = 50;
constexpr double kEndless = 1e-12;  ///< part of a normal along an endless way, beyond which no plane touches the wheel
constexpr double kParallel = 1e-9;  ///< change along the spindle for each metre of a ray, below which there is none

bool isEmpty(const Range& range) { return !(range.from <= range.to); }

Range common(const Range& a, const Range& b) { return {std::max(a.from, b.from), std::min(a.to, b.to)}; }

/// Where a linear function of X is within a range.
Range where(double value, double per_x, const Range& range) {
  if (isEmpty(range)) return kNothing;
  if (std::abs(per_x) < kParallel) {
    return value >= range.from && value <= range.to ? Range{-kInfinity, kInfinity} : kNothing;
  }
  const double a = (range.from - value) / per_x, b = (range.to - value) / per_x;
  return {std::min(a, b), std::max(a, b)};
}

/// The places across at which a disc is as high as `along`.
Range chord(const Vector2d& centre, double radius, double along) {
  const double off = along - centre[1], square = radius * radius - off * off;
  if (!(square >= 0)) return kNothing;
  return {centre[0] - std::sqrt(square), centre[0] + std::sqrt(square)};
}

/// Where a function that has another sign at `from` than at `to` is 0.
template <typename Function>
double boundary(const Function& f, double from, double at_from, double to, double at_to) {
  if (at_from == 0) return from;
  if (at_to == 0) return to;
  std::uintmax_t steps = kRootSteps;
  const boost::math::tools::eps_tolerance<double> close(kRootBits);
  const auto [low, high] = boost::math::tools::toms748_solve(f, from, to, at_from, at_to, close, steps);
  return (low + high) / 2;
}

}  // namespace

FaceSweep::FaceSweep(const FaceStroke& stroke, const FaceWheel& wheel, WheelProfile profile, double end_radius,
                     double tooth_angle)
    : profile_(std::move(profile)),
      inner_radius_(wheel.inner_radius),
      cos_a_(std::cos(stroke.to[kA] + tooth_angle)),
      sin_a_(std::sin(stroke.to[kA] + tooth_angle)),
      spindle_(-std::sin(stroke.swivel), 0, std::cos(stroke.swivel)),
      across_(std::cos(stroke.swivel), 0, std::sin(stroke.swivel)) {
  const auto centre = [&](const Axes& at) -> Vector3d {
    const Vector3d of_new(at[kX], end_radius + wheel.nominal_radius + at[kY], wheel.height + at[kZ]);
    return of_new + wheel.face_wear / 2 * spindle_;
  };
  end_ = centre(stroke.to);
  const Vector3d way = centre(stroke.from) - end_;
  plunges_ = std::abs(way.dot(spindle_)) > kParallel * way.norm();
  const Vector2d begin(way.dot(across_), way[1]);
  legs_.push_back({Vector2d::Zero(), Vector2d::Zero(), true});
  if (std::abs(begin[0]) <= kParallel * begin.norm()) return;
  legs_.push_back({Vector2d::Zero(), begin, false});
}

FaceSweep::Ray FaceSweep::inWheel(const OnRay& ray) const {
  const Vector3d at = Vector3d(0, ray[0] * cos_a_ + ray[1] * sin_a_, ray[1] * cos_a_ - ray[0] * sin_a_) - end_;
  return {at.dot(spindle_), spindle_[0], {at.dot(across_), at[1]}, {across_[0], 0}};
}

bool FaceSweep::removes(const OnRay& on_ray, double x) const {
  const Ray ray = inWheel(on_ray);
  if (plunges_) return x <= plungedTo(ray);
  return std::any_of(legs_.begin(), legs_.end(), [&](const Leg& leg) { return covers(ray, leg, x); });
}

std::optional<double> FaceSweep::removedTo(const OnRay& on_ray, double x) const {
  const Ray ray = inWheel(on_ray);
  if (plunges_) {
    const double to = plungedTo(ray);
    return x <= to ? std::optional(to) : std::nullopt;
  }
  // The ray may pass the legs in either order.
  const Leg* last = nullptr;
  for (std::size_t i = 0; i < 2 * legs_.size() - 1; ++i) {
    const Leg& leg = legs_[i % legs_.size()];
    if (&leg == last || !covers(ray, leg, x)) continue;
    x = coveredTo(ray, leg, x);
    last = &leg;
  }
  return last != nullptr ? std::optional(x) : std::nullopt;
}

double FaceSweep::Leg::squaredDistance(const Vector2d& at) const noexcept {
  if (endless) return Vector2d(at[0] - to[0], std::min(0.0, at[1] - to[1])).squaredNorm();
  const Vector2d way = to - from;
  const double part = std::clamp((at - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (at - from - part * way).squaredNorm();
}

Range FaceSweep::Leg::within(double distance, double along) const noexcept {
  if (endless) return along >= to[1] ? Range{to[0] - distance, to[0] + distance} : chord(to, distance, along);
  Range range = kNothing;
  const auto take = [&range](const Range& other) {
    if (!isEmpty(other)) range = {std::min(range.from, other.from), std::max(range.to, other.to)};
  };
  take(chord(from, distance, along));
  take(chord(to, distance, along));
  const Vector2d way = to - from;
  const Vector2d aside = distance / way.norm() * Vector2d(-way[1], way[0]);
  for (const double side : {-1.0, 1.0}) {
    const double part = (along - from[1] - side * aside[1]) / way[1];
    if (part >= 0 && part <= 1) {
      const double at = from[0] + side * aside[0] + part * way[0];
      take({at, at});
    }
  }
  return range;
}

/// How far a place of the ray is inside the wheel, along its radius; negative outside it.
double FaceSweep::depth(const Ray& ray, const Leg& leg, double x) const {
  return profile_.radius(ray.w + x * ray.w_per_x) - std::sqrt(leg.squaredDistance(ray.at + x * ray.at_per_x));
}

bool FaceSweep::covers(const Ray& ray, const Leg& leg, double x) const {
  const double w = ray.w + x * ray.w_per_x;
  if (!(w >= profile_.lowerFace() && w <= profile_.upperFace())) return false;
  const double radius = profile_.radius(w);
  return leg.squaredDistance(ray.at + x * ray.at_per_x) <= radius * radius;
}

/// The depth is concave along the ray: there is one end, beyond any place that is covered.
double FaceSweep::coveredTo(const Ray& ray, const Leg& leg, double x) const {
  const Range reach = common(where(ray.w, ray.w_per_x, {profile_.lowerFace(), profile_.upperFace()}),
                             where(ray.at[0], ray.at_per_x[0], leg.within(profile_.maxRadius(), ray.at[1])));
  if (!(reach.to > x)) return x;
  const auto depth_at = [&](double at) { return depth(ray, leg, at); };
  const double at_end = depth_at(reach.to);
  return at_end >= 0 ? reach.to : boundary(depth_at, x, depth_at(x), reach.to, at_end);
}

/// Fed along the ray, the wheel removes all up to where its rim is at last.
double FaceSweep::plungedTo(const Ray& ray) const {
  const Leg end{Vector2d::Zero(), Vector2d::Zero(), false};
  const auto disc = [&](double radius) { return where(ray.at[0], ray.at_per_x[0], chord(end.to, radius, ray.at[1])); };
  const Range faces = where(ray.w, ray.w_per_x, {profile_.lowerFace(), profile_.upperFace()});
  const Range wheel = common(faces, disc(profile_.maxRadius())), hollow = disc(inner_radius_);
  if (isEmpty(wheel)) return -kInfinity;
  const double to = wheel.to > hollow.from && wheel.to < hollow.to ? hollow.from : wheel.to;
  return to >= wheel.from ? to : -kInfinity;
}

RemovedVolume FaceSweep::volume(double error) const {
  RemovedVolume volume;
  if (plunges_) {
    addPlunged(error, volume);
  } else {
    addPlanes(error, volume);
  }
  return volume;
}

/// The plane that touches the wheel on its way at a place of the wheel in its pose at the stroke's end, seen from the
/// wheel, in the tool's frame.
/// @param at from the wheel's centre.
Plane FaceSweep::touching(const Vector3d& outward, const Vector3d& at) const {
  double offset = outward.dot(end_ + at);
  for (const Leg& leg : legs_) {
    if (!leg.endless && !plunges_)
      offset += std::max(0.0, outward.dot(leg.to[0] * across_ + leg.to[1] * Vector3d::UnitY()));
  }
  const Vector3d inward = -outward;
  const double cos = cos_a_, sin = sin_a_;
  return {{inward[0], inward[1] * cos - inward[2] * sin, inward[1] * sin + inward[2] * cos}, -offset};
}

/// The planes of a wheel that comes in its face's plane and goes out along Y. They also enclose the corner between the
/// two legs, which is as far from the rim as the wheel's radius: no tool is there.
void FaceSweep::addPlanes(double error, RemovedVolume& volume) const {
  const std::vector<ProfilePoint> outline = profile_.outline(error);
  const Vector3d up = Vector3d::UnitY();
  volume.body = {touching(spindle_, profile_.upperFace() * spindle_),
                 touching(-spindle_, profile_.lowerFace() * spindle_)};
  const auto add = [&](double angle) {
    const Vector3d radial = std::cos(angle) * across_ + std::sin(angle) * up;
    for (std::size_t i = 1; i < outline.size(); ++i) {
      const ProfilePoint &from = outline[i - 1], &to = outline[i];
      const Vector3d outward = ((to.w - from.w) * radial - (to.radius - from.radius) * spindle_).normalized();
      if (outward[1] > kEndless) continue;
      volume.body.push_back(touching(outward, to.w * spindle_ + to.radius * radial));
    }
  };
  // First the bottom, square to the way in.
  const Vector2d way = legs_.back().endless ? Vector2d(1, 0) : legs_.back().to;
  const double bottom = way[0] > 0 ? std::atan2(-way[0], way[1]) : std::atan2(way[0], -way[1]);
  const double step = std::sqrt(8 * error / profile_.maxRadius());
  add(bottom);
  for (int i = 1; i * step < units::kPi; ++i) {
    if (bottom - i * step > -units::kPi) add(bottom - i * step);
    if (bottom + i * step < 0) add(bottom + i * step);
  }
  add(0);
  add(-units::kPi);
}

/// The planes of a cup that is fed along X, in front of its lower face.
void FaceSweep::addPlunged(double error, RemovedVolume& volume) const {
  const Vector3d low = profile_.lowerFace() * spindle_, high = profile_.upperFace() * spindle_;
  volume.body.push_back(touching(-spindle_, low));
  const double step = std::sqrt(8 * error / profile_.maxRadius());
  for (double angle = 0; angle < units::kTurn; angle += step) {
    const Vector3d radial = std::cos(angle) * across_ + std::sin(angle) * Vector3d::UnitY();
    // The planes along X that touch an edge of the rim.
    const Vector3d along = (radial - radial[0] / spindle_[0] * spindle_).normalized();
    const Vector3d& edge = along.dot(spindle_) > 0 ? high : low;
    volume.body.push_back(touching(along, edge + profile_.maxRadius() * radial));
    if (radial[0] > 0) volume.body.push_back(touching(radial, profile_.maxRadius() * radial));
    if (!(inner_radius_ > 0)) continue;
    for (const Vector3d& outward : {along, radial}) {
      const Plane plane = touching(outward, low + inner_radius_ * radial);
      volume.hollow.push_back({-plane.normal, -plane.offset});
    }
  }
}

}  // namespace grinder
