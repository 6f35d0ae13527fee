#pragma once

#include "flute_grinder/check/solid.h"
#include "random_cases.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace grinder {

/// The minimum value of a convex function between two ends, by golden section.
/// @param within of the place where it is least.
template <typename Function>
double minOf(double low, double high, const Function& value, double within = 1e-9) {
  constexpr double part = 0.6180339887498949;
  double a = high - part * (high - low), b = low + part * (high - low);
  double at_a = value(a), at_b = value(b);
  while (high - low > within) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      at_a = value(a = high - part * (high - low));
    } else {
      low = a, a = b, at_a = at_b;
      at_b = value(b = low + part * (high - low));
    }
  }
  return std::min(at_a, at_b);
}

/// A cylinder about Z, or a box, in a frame of its own.
struct Shape {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  bool is_box = false;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< of a box
  double radius = 0, half_length = 0;              ///< of a cylinder

  Solid solid() const {
    Solid solid = is_box ? Solid::box(2 * half) : Solid::cylinder(radius, 2 * half_length);
    solid.pose = pose;
    return solid;
  }

  /// Distance of a point that is outside, 0 of others.
  double distance(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = pose.inverse() * point;
    if (is_box) return (p.cwiseAbs() - half).cwiseMax(0).norm();
    return std::hypot(std::max(0.0, p.head<2>().norm() - radius), std::max(0.0, std::abs(p.z()) - half_length));
  }

  /// Distance of another convex body: the least over all points of this one. Independent of support functions and GJK.
  template <typename Body>
  double distance(const Body& other, double within = 1e-9) const {
    const double z_half = is_box ? half.z() : half_length;
    const double x_half = is_box ? half.x() : radius;
    const auto over = [&](double half, const auto& value) { return minOf(-half, half, value, within); };
    return over(z_half, [&](double z) {
      return over(x_half, [&](double x) {
        const double y_half = is_box ? half.y() : std::sqrt(std::max(0.0, radius * radius - x * x));
        return over(y_half, [&](double y) { return other.distance(Eigen::Vector3d(pose * Eigen::Vector3d(x, y, z))); });
      });
    });
  }
};

/// A straight wheel in the cutter's frame; its axis is along (-sin s, 0, cos s).
inline Shape wheelAt(const Eigen::Vector3d& centre, double swivel, double radius, double width) {
  Shape wheel;
  wheel.pose = Eigen::Translation3d(centre) * Eigen::AngleAxisd(-swivel, Eigen::Vector3d::UnitY());
  wheel.radius = radius;
  wheel.half_length = width / 2;
  return wheel;
}

}  // namespace grinder
