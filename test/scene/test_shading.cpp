#include "scene/shading.h"

#include "flute_grinder/base/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace grinder {
namespace test_shading {

using Eigen::Vector3d;
using units::kDegree;

/// A cylinder of radius and length 1 about X, closed before and behind, whose facets turn by a step each.
std::vector<Vector3d> cylinder(double step) {
  std::vector<Vector3d> corners;
  const auto at = [](double x, double angle) { return Vector3d(x, std::cos(angle), std::sin(angle)); };
  for (double a = 0; a < 360 * kDegree - step / 2; a += step) {
    const double b = a + step;
    corners.insert(corners.end(), {at(0, a), at(1, b), at(1, a), at(0, a), at(0, b), at(1, b)});
    corners.insert(corners.end(), {{0, 0, 0}, at(0, b), at(0, a), {1, 0, 0}, at(1, a), at(1, b)});
  }
  return corners;
}

TEST(Shading, IsSmoothOnACylinderAndHasItsEdges) {
  const double step = 6 * kDegree;
  const std::vector<Vector3d> corners = cylinder(step);
  const std::vector<Vector3d> normals = smoothNormals(corners);
  ASSERT_EQ(normals.size(), corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool is_face = i % 12 >= 6;
    const Vector3d radial(0, corners[i].y(), corners[i].z());
    const Vector3d surface = is_face ? Vector3d(i % 12 < 9 ? -1 : 1, 0, 0) : radial;
    const double off = std::acos(std::min(1.0, normals[i].dot(surface)));
    EXPECT_LT(off, is_face ? 1e-9 : step / 4) << i;
  }
}

TEST(Shading, OfASliverIsThatOfItsNeighbours) {
  // Two triangles of a plane, and between them one of no width that rounding errors have turned upright, which shares
  // two corners.
  const Vector3d a(0, 0, 0), b(1, 0, 0), top(0.5, 1, 0), low(0.5, -1, 0), off(0.5, 0, 1e-7);
  const std::vector<Vector3d> corners{a, b, top, b, a, low, a, off, b};
  const std::vector<Vector3d> normals = smoothNormals(corners);
  for (const std::size_t i : {6, 8}) EXPECT_NEAR(normals[i].z(), 1, 1e-6) << i;
}

TEST(Shading, MakesNoSideBlackAndNotAllAlike) {
  const std_msgs::ColorRGBA white = [] {
    std_msgs::ColorRGBA c;
    c.r = c.g = c.b = c.a = 1;
    return c;
  }();
  float least = 1, most = 0;
  for (double angle = 0; angle < 360 * kDegree; angle += 5 * kDegree) {
    const std_msgs::ColorRGBA seen = lit(white, {0, std::cos(angle), std::sin(angle)});
    EXPECT_EQ(seen.a, 1);
    least = std::min(least, seen.r);
    most = std::max(most, seen.r);
  }
  EXPECT_GT(least, 0.3);
  EXPECT_LT(least, 0.8 * most);
  EXPECT_LT(most, 1) << "the highlight keeps its colour";
}

}  // namespace test_shading
}  // namespace grinder
