#include "tool/polygon.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace grinder {

namespace {

using Eigen::Vector3d;

constexpr double kOnPlane = 1e-12;  ///< distance within which a corner is on the plane that cut it [m]

bool comesBefore(const Vector3d& a, const Vector3d& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] != b[i]) return a[i] < b[i];
  }
  return false;
}

/// The point where an edge passes through the plane, whichever way round the edge is given.
Vector3d crossing(const Plane& plane, const Vector3d& a, const Vector3d& b) {
  if (comesBefore(b, a)) return crossing(plane, b, a);
  const double at_a = plane.height(a), at_b = plane.height(b);
  // Exact: a corner may lie in several planes, as the axis does in both of a wedge.
  if (at_a == 0) return a;
  if (at_b == 0) return b;
  return a + at_a / (at_a - at_b) * (b - a);
}

/// The corners other than the first, so that all four are an even permutation.
constexpr std::array<std::array<std::size_t, 3>, 4> kOtherCorners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The convex polygon of points in a plane.
Polygon around(std::vector<Vector3d> points, const Vector3d& normal) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : points) middle += p / static_cast<double>(points.size());
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const auto angle = [&](const Vector3d& p) { return std::atan2((p - middle).dot(v), (p - middle).dot(u)); };
  std::sort(points.begin(), points.end(), [&](const Vector3d& a, const Vector3d& b) { return angle(a) < angle(b); });
  return points;
}

}  // namespace

Polygon clipped(const Polygon& polygon, const Plane& plane, bool in_front) {
  Polygon result;
  result.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % polygon.size()];
    const bool a_in_front = plane.height(a) > 0, b_in_front = plane.height(b) > 0;
    if (a_in_front == in_front) result.push_back(a);
    if (a_in_front != b_in_front) result.push_back(crossing(plane, a, b));
  }
  if (result.size() < 3) result.clear();
  return result;
}

Polygon section(const TetrahedronCorners& corners, const Plane& plane) {
  std::array<bool, 4> front{};
  for (std::size_t i = 0; i < 4; ++i) front[i] = plane.height(corners[i]) > 0;
  const auto cut = [&](std::size_t i, std::size_t k) { return crossing(plane, corners[i], corners[k]); };
  const auto in_front = std::count(front.begin(), front.end(), true);
  if (in_front == 0 || in_front == 4) return {};
  if (in_front != 2) {
    const auto i = static_cast<std::size_t>(std::find(front.begin(), front.end(), in_front == 1) - front.begin());
    const auto [p, q, r] = kOtherCorners[i];
    return in_front == 1 ? Polygon{cut(i, p), cut(i, r), cut(i, q)} : Polygon{cut(i, p), cut(i, q), cut(i, r)};
  }
  const auto i = static_cast<std::size_t>(std::find(front.begin(), front.end(), true) - front.begin());
  std::array<std::size_t, 3> others = kOtherCorners[i];
  while (!front[others[0]]) std::rotate(others.begin(), others.begin() + 1, others.end());
  const auto [k, p, q] = others;
  return {cut(i, p), cut(k, p), cut(k, q), cut(i, q)};
}

ConvexPart::ConvexPart(const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {box.least[axis], box.most[axis]}) {
      std::vector<Vector3d> corners(4, Vector3d::Zero());
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (std::size_t i = 0; i < 4; ++i) {
        corners[i][axis] = side;
        corners[i][u] = i == 0 || i == 3 ? box.least[u] : box.most[u];
        corners[i][v] = i < 2 ? box.least[v] : box.most[v];
      }
      faces_.push_back(std::move(corners));
    }
  }
}

bool ConvexPart::cut(const Plane& plane) {
  const auto is_in_front = [&](const Vector3d& p) { return plane.height(p) > kOnPlane; };
  const auto whole = [&](const Polygon& face) { return std::all_of(face.begin(), face.end(), is_in_front); };
  if (std::all_of(faces_.begin(), faces_.end(), whole)) return false;
  std::vector<Polygon> left;
  std::vector<Vector3d> on_plane;
  for (const Polygon& face : faces_) {
    Polygon part = clipped(face, plane, true);
    if (part.empty()) continue;
    for (const Vector3d& p : part) {
      if (!is_in_front(p)) on_plane.push_back(p);
    }
    left.push_back(std::move(part));
  }
  faces_ = std::move(left);
  if (!faces_.empty() && on_plane.size() >= 3) faces_.push_back(around(std::move(on_plane), plane.normal));
  return true;
}

bool ConvexPart::hasFaceOn(const Plane& plane) const {
  const auto is_on = [&](const Vector3d& p) { return std::abs(plane.height(p)) <= kOnPlane; };
  return std::any_of(faces_.begin(), faces_.end(),
                     [&](const Polygon& face) { return std::all_of(face.begin(), face.end(), is_on); });
}

Box ConvexPart::bounds() const {
  Box box{faces_.front().front(), faces_.front().front()};
  for (const Polygon& face : faces_) {
    for (const Vector3d& p : face) box = {box.least.cwiseMin(p), box.most.cwiseMax(p)};
  }
  return box;
}

}  // namespace grinder
