#include "flute_grinder/tool/wedge_cut.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grinder {

namespace {

using Eigen::Vector3d;
using Polygon = WedgeCut::Polygon;

bool comesBefore(const Vector3d& a, const Vector3d& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] != b[i]) return a[i] < b[i];
  }
  return false;
}

/// The point where an edge passes through the plane, whichever way round the edge is given.
Vector3d crossing(const Vector3d& normal, const Vector3d& a, const Vector3d& b) {
  if (comesBefore(b, a)) return crossing(normal, b, a);
  const double at_a = normal.dot(a), at_b = normal.dot(b);
  // Exact, as the axis lies in both half planes.
  if (at_a == 0) return a;
  if (at_b == 0) return b;
  return a + at_a / (at_a - at_b) * (b - a);
}

/// The part of a polygon on one side of a plane; the plane itself counts as behind.
Polygon clipped(const Polygon& polygon, const Vector3d& normal, bool in_front) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % polygon.size()];
    const bool a_in_front = normal.dot(a) > 0, b_in_front = normal.dot(b) > 0;
    if (a_in_front == in_front) result.push_back(a);
    if (a_in_front != b_in_front) result.push_back(crossing(normal, a, b));
  }
  return result;
}

/// The corners other than the first, so that all four are an even permutation.
constexpr std::array<std::array<std::size_t, 3>, 4> kOthers{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The section of a tetrahedron with a plane, its corners counterclockwise as seen from the plane's front; clockwise in
/// a tetrahedron that is turned inside out, so that it cancels the doubly covered parts.
Polygon section(const std::array<Vector3d, 4>& corners, const Vector3d& normal) {
  std::array<bool, 4> front{};
  for (std::size_t i = 0; i < 4; ++i) front[i] = normal.dot(corners[i]) > 0;
  const auto cut = [&](std::size_t i, std::size_t k) { return crossing(normal, corners[i], corners[k]); };
  const auto in_front = std::count(front.begin(), front.end(), true);
  if (in_front == 0 || in_front == 4) return {};
  if (in_front != 2) {
    const auto i = static_cast<std::size_t>(std::find(front.begin(), front.end(), in_front == 1) - front.begin());
    const auto [p, q, r] = kOthers[i];
    return in_front == 1 ? Polygon{cut(i, p), cut(i, r), cut(i, q)} : Polygon{cut(i, p), cut(i, q), cut(i, r)};
  }
  const auto i = static_cast<std::size_t>(std::find(front.begin(), front.end(), true) - front.begin());
  std::array<std::size_t, 3> others = kOthers[i];
  while (!front[others[0]]) std::rotate(others.begin(), others.begin() + 1, others.end());
  const auto [k, p, q] = others;
  return {cut(i, p), cut(k, p), cut(k, q), cut(i, q)};
}

void append(std::vector<Polygon>& all, Polygon&& polygon) {
  if (polygon.size() >= 3) all.push_back(std::move(polygon));
}

}  // namespace

WedgeCut::WedgeCut(const Wedge& wedge)
    : from_(0, -std::sin(wedge.from), std::cos(wedge.from)), to_(0, std::sin(wedge.to), -std::cos(wedge.to)) {
  if (wedge.to > wedge.from && wedge.to - wedge.from < units::kPi) return;
  throw std::invalid_argument(
      format("wedge from %g to %g rad; allowed: rising, by less than half a turn", wedge.from, wedge.to));
}

std::vector<Polygon> WedgeCut::outside(const std::array<Vector3d, 3>& triangle) const {
  const Polygon whole(triangle.begin(), triangle.end());
  std::vector<Polygon> result;
  append(result, clipped(whole, from_, false));
  append(result, clipped(clipped(whole, from_, true), to_, false));
  return result;
}

std::vector<Polygon> WedgeCut::faces(const std::array<Vector3d, 4>& tetrahedron) const {
  std::vector<Polygon> result;
  append(result, clipped(section(tetrahedron, from_), to_, true));
  append(result, clipped(section(tetrahedron, to_), from_, true));
  return result;
}

}  // namespace grinder
