#include "tool/face_sweep.h"

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
  const auto centre = [&](const Axes& at) {
    return Vector3d(at[kX], end_radius + wheel.nominal_radius + at[kY], wheel.height + at[kZ]);
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
  // From one leg the ray may go on into another, and back.
  const Leg* last = nullptr;
  for (std::size_t i = 0; i < 2 * legs_.size() - 1; ++i) {
    const Leg& leg = legs_[i % legs_.size()];
    if (&leg == last || !covers(ray, leg, x)) continue;
    x = coveredTo(ray, leg, x);
    last = &leg;
  }
  return last != nullptr ? std::optional(x) : std::nullopt;
}

double FaceSweep::Leg::distance(const Vector2d& at) const noexcept {
  if (endless) return Vector2d(at[0] - to[0], std::min(0.0, at[1] - to[1])).norm();
  const Vector2d way = to - from;
  const double part = std::clamp((at - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (at - from - part * way).norm();
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
  return profile_.radius(ray.w + x * ray.w_per_x) - leg.distance(ray.at + x * ray.at_per_x);
}

bool FaceSweep::covers(const Ray& ray, const Leg& leg, double x) const {
  const double w = ray.w + x * ray.w_per_x;
  return w >= profile_.lowerFace() && w <= profile_.upperFace() && depth(ray, leg, x) >= 0;
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

}  // namespace grinder
