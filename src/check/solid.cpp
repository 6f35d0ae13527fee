#include "flute_grinder/check/solid.h"

#if __has_include(<fcl/narrowphase/gjk_libccd.h>)
#define FLUTE_GRINDER_FCL_0_5  // as in Ubuntu 20.04
#include <fcl/narrowphase/gjk_libccd.h>
#else
#include <fcl/narrowphase/detail/convexity_based_algorithm/gjk_libccd.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace grinder {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kProfilePoints = 64;       ///< points over the width of a wheel, closer together toward its faces
constexpr double kCoaxial = 1e-9;        ///< tolerance for coaxial bodies [m], and for a direction
constexpr double kAccuracy = 1e-6;       ///< [m]
constexpr double kGjkTolerance = 1e-11;  ///< largest last step of GJK [m]
constexpr unsigned kGjkIterations = 500;
constexpr int kAttempts = 12;  ///< seven were enough in 20000 random pairs

/// A body as GJK sees it: shifted, in a turned frame.
struct View {
  const Solid* solid;
  Eigen::Vector3d shift;
  Eigen::Matrix3d frame;
  mutable Eigen::Vector3d asked = Eigen::Vector3d::Zero();  ///< the last direction asked for, in the frame
};

void farthestOf(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const View& view = *static_cast<const View*>(object);
  const Eigen::Vector3d d(direction->v[0], direction->v[1], direction->v[2]);
  view.asked = d;
  const Eigen::Vector3d p = view.frame * (view.solid->farthest(view.frame.transpose() * d) + view.shift);
  for (int i = 0; i < 3; ++i) point->v[i] = p[i];
}

/// The vector from a body's nearest point to the other's, in the frame, by GJK. This is FCL's own, from its namespace
/// detail, since no shape of its public interface has a wheel's rings: fcl::distance() would need a polyhedron, which
/// is 15 um off with 128 corners to a ring and takes 55 us, and 1 um off with 512 corners and takes 250 us. gap() takes
/// 14 us.
/// @return nothing if GJK finds no distance.
std::optional<Eigen::Vector3d> wayBetween(View& first, View& second) {
  double distance = 0;
#ifdef FLUTE_GRINDER_FCL_0_5
  // The nearest points of this GJK are wrong; its distance and its last search direction are right.
  if (!fcl::details::GJKDistance(&first, farthestOf, &second, farthestOf, kGjkIterations, kGjkTolerance, &distance,
                                 nullptr, nullptr)) {
    return std::nullopt;
  }
  return distance * first.asked.normalized();
#else
  Eigen::Vector3d on_first, on_second;
  if (!fcl::detail::GJKDistance<double>(&first, farthestOf, &second, farthestOf, kGjkIterations, kGjkTolerance,
                                        &distance, &on_first, &on_second)) {
    return std::nullopt;
  }
  return on_second - on_first;
#endif
}

}  // namespace

Solid Solid::box(const Eigen::Vector3d& sides) {
  Solid solid;
  solid.half = sides / 2;
  return solid;
}

Solid Solid::cylinder(double radius, double length) {
  Solid solid;
  solid.rings = {{-length / 2, radius}, {length / 2, radius}};
  return solid;
}

Solid Solid::sphere(double radius) {
  Solid solid;
  solid.thickness = radius;
  return solid;
}

Solid Solid::wheel(const WheelProfile& profile) {
  Solid solid;
  solid.name = "wheel";
  solid.rings.clear();
  const double middle = (profile.lowerFace() + profile.upperFace()) / 2;
  const double half_width = (profile.upperFace() - profile.lowerFace()) / 2;
  for (int i = 0; i <= kProfilePoints; ++i) {
    const double w = middle - half_width * std::cos(kPi * i / kProfilePoints);
    solid.rings.push_back({w, profile.radius(w)});
  }
  for (const ProfilePoint& corner : profile.corners()) solid.rings.push_back({corner.w, profile.radius(corner.w)});
  return solid;
}

Eigen::Vector3d Solid::farthest(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d d = pose.linear().transpose() * direction;
  Eigen::Vector3d point = half.cwiseProduct(d.unaryExpr([](double v) { return v < 0 ? -1.0 : 1.0; }));
  const double across = std::hypot(d.x(), d.y());
  const auto ring = std::max_element(rings.begin(), rings.end(), [&](const ProfilePoint& a, const ProfilePoint& b) {
    return a.radius * across + a.w * d.z() < b.radius * across + b.w * d.z();
  });
  point.z() += ring->w;
  if (across > 0) point.head<2>() += ring->radius / across * d.head<2>();
  if (thickness > 0) point += thickness * d.normalized();
  return pose * point;
}

Solid Solid::swept(const Eigen::Isometry3d& axis) const {
  Solid solid;
  solid.name = name;
  solid.pose = axis;
  solid.thickness = thickness;
  solid.rings.clear();
  const Eigen::Isometry3d own = axis.inverse() * pose;
  const double direction = own.linear()(2, 2);
  const bool coaxial =
      half.isZero() && 1 - std::abs(direction) < kCoaxial && own.translation().head<2>().norm() < kCoaxial;
  for (const ProfilePoint& ring : rings) {
    if (coaxial) {
      solid.rings.push_back({own.translation().z() + direction * ring.w, ring.radius});
      continue;
    }
    // The corners of a box about the body: the hull of their circles contains the box at any angle.
    const Eigen::Vector3d side = half + Eigen::Vector3d(ring.radius, ring.radius, 0);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
      const Eigen::Vector3d p = own * (sign.cwiseProduct(side) + Eigen::Vector3d(0, 0, ring.w));
      solid.rings.push_back({p.z(), p.head<2>().norm()});
    }
  }
  return solid;
}

Gap gap(const Solid& first, const Solid& second, const Eigen::Vector3d& shift) {
  Gap best;
  double nearest_points = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < kAttempts && !(nearest_points - best.distance <= kAccuracy); ++attempt) {
    const Eigen::Matrix3d frame = Eigen::AngleAxisd(attempt, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    View views[]{{&first, Eigen::Vector3d::Zero(), frame}, {&second, shift, frame}};
    const auto between = wayBetween(views[0], views[1]);
    if (!between) continue;
    const Eigen::Vector3d way = frame.transpose() * *between;
    nearest_points = std::min(nearest_points, way.norm());
    const Eigen::Vector3d normal = way.normalized();
    const double planes = normal.dot(second.farthest(-normal) + shift - first.farthest(normal));
    if (planes > best.distance) best = {planes, normal};
  }
  return best;
}

}  // namespace grinder
