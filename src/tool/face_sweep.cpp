#include "tool/face_sweep.h"

#include "tool/change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grinder {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kNothing{kInfinity, -kInfinity};
constexpr int kGoldenSteps = 50;
constexpr double kGolden = 0.6180339887498949;
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

}  // namespace

FaceSweep::FaceSweep(const FaceStroke& stroke, const FaceWheel& wheel, WheelProfile profile, double end_radius,
                     double tooth_angle)
    : profile_(std::move(profile)),
      inner_radius_(wheel.inner_radius),
      a_(stroke.to[kA] + tooth_angle),
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

void FaceSweep::addRemoved(double r, double angle, std::vector<Range>& ranges) const {
  const double turn = angle - a_;
  const Vector3d at = Vector3d(0, r * std::cos(turn), r * std::sin(turn)) - end_;
  const Ray ray{at.dot(spindle_), spindle_[0], {at.dot(across_), at[1]}, {across_[0], 0}};
  if (plunges_) return addPlunged(ray, ranges);
  for (const Leg& leg : legs_) {
    const Range range = removed(ray, leg);
    if (!isEmpty(range)) ranges.push_back(range);
  }
}

double FaceSweep::Leg::distance(const Vector2d& at) const noexcept {
  if (endless) return std::hypot(at[0] - to[0], std::min(0.0, at[1] - to[1]));
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

Range FaceSweep::removed(const Ray& ray, const Leg& leg) const {
  const Range reach = common(where(ray.w, ray.w_per_x, {profile_.lowerFace(), profile_.upperFace()}),
                             where(ray.at[0], ray.at_per_x[0], leg.within(profile_.maxRadius(), ray.at[1])));
  if (isEmpty(reach)) return kNothing;
  const auto in_wheel = [&](double x) { return depth(ray, leg, x) >= 0; };
  if (in_wheel(reach.from) && in_wheel(reach.to)) return reach;
  // The depth is concave along the ray: there is one range, about any place that is inside.
  const Range cylinder = common(reach, where(ray.w, ray.w_per_x, profile_.maxPlace()));
  double inside = (cylinder.from + cylinder.to) / 2;
  if (isEmpty(cylinder)) {
    double from = reach.from, to = reach.to;
    for (int i = 0; i < kGoldenSteps; ++i) {
      const double low = to - kGolden * (to - from), high = from + kGolden * (to - from);
      if (depth(ray, leg, low) > depth(ray, leg, high)) {
        to = high;
      } else {
        from = low;
      }
    }
    inside = (from + to) / 2;
  }
  if (!in_wheel(inside)) return kNothing;
  return {in_wheel(reach.from) ? reach.from : changeBetween(reach.from, inside, in_wheel),
          in_wheel(reach.to) ? reach.to : changeBetween(reach.to, inside, in_wheel)};
}

/// Fed along the ray, the wheel removes all up to where its rim is at last.
void FaceSweep::addPlunged(const Ray& ray, std::vector<Range>& ranges) const {
  const Leg end{Vector2d::Zero(), Vector2d::Zero(), false};
  const auto disc = [&](double radius) { return where(ray.at[0], ray.at_per_x[0], chord(end.to, radius, ray.at[1])); };
  const Range faces = where(ray.w, ray.w_per_x, {profile_.lowerFace(), profile_.upperFace()});
  const Range wheel = common(faces, disc(profile_.maxRadius())), hollow = disc(inner_radius_);
  if (isEmpty(wheel)) return;
  double to = wheel.to;
  if (to > hollow.from && to < hollow.to) to = hollow.from;
  if (to >= wheel.from) ranges.push_back({-kInfinity, to});
}

}  // namespace grinder
