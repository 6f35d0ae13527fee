#include "flute_grinder/scene/first_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

namespace grinder {
namespace test_first_view {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Of the markers of a namespace: along the axis of revolution, and farthest from it.
struct Size {
  double from = 1e9, to = -1e9, radius = 0;
};

Size sizeOf(const MarkerArray& array, const std::string& ns, const std::string& frame) {
  Size size;
  for (const Marker& m : array.markers) {
    if (m.ns != ns) continue;
    EXPECT_EQ(m.header.frame_id, frame);
    EXPECT_EQ(m.type, Marker::TRIANGLE_LIST);
    for (const geometry_msgs::Point& p : m.points) {
      size.from = std::min(size.from, p.x);
      size.to = std::max(size.to, p.x);
      size.radius = std::max(size.radius, std::hypot(p.y, p.z));
    }
  }
  return size;
}

TEST(FirstView, HasWheelAndBlankOfTheirSizesAndFewPoints) {
  const MarkerArray array = firstViewMarkers({0.08, 0.006, 0.012, 0.05});
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  const Size wheel = sizeOf(array, "wheel", "wheel"), blank = sizeOf(array, "blank", "cutter");
  EXPECT_NEAR(wheel.from, -0.003, 1e-12);
  EXPECT_NEAR(wheel.to, 0.003, 1e-12);
  EXPECT_NEAR(wheel.radius, 0.04, 1e-12);
  EXPECT_NEAR(blank.from, 0, 1e-12);
  EXPECT_NEAR(blank.to, 0.05, 1e-12);
  EXPECT_NEAR(blank.radius, 0.006, 1e-12);
  std::size_t points = 0;
  for (const Marker& m : array.markers) {
    if (m.ns != "wheel") continue;
    points += m.points.size();
    const auto& q = m.pose.orientation;
    // The wheel's outline turns about Z: where its axis X comes to.
    EXPECT_NEAR(2 * (q.x * q.z - q.y * q.w), 1, 1e-12);
  }
  EXPECT_GT(points, 1000u);
  EXPECT_LT(points, 5000u) << "each costs time in every frame";
}

/// The radius of a wheel's markers at the circles of their outline, by their distance along the axis [nm].
std::map<long, double> outlineOf(const WheelProfile& wheel) {
  MarkerArray array;
  appendWheel(array, wheel);
  std::map<long, double> outline;
  for (const Marker& m : array.markers) {
    for (const geometry_msgs::Point& p : m.points) {
      double& radius = outline[std::lround(1e9 * p.x)];
      radius = std::max(radius, std::hypot(p.y, p.z));
    }
  }
  return outline;
}

TEST(FirstView, AWheelHasTheOutlineOfItsProfile) {
  for (const WheelProfile& wheel :
       {WheelProfile::straight(0.1, 0.006, {0.001, 0.002}), WheelProfile::fullRadius(0.1, 0.006)}) {
    const std::map<long, double> outline = outlineOf(wheel);
    ASSERT_FALSE(outline.empty());
    ASSERT_EQ(outline.begin()->first, -3000000);
    ASSERT_EQ(outline.rbegin()->first, 3000000);
    for (const auto& [w, radius] : outline) EXPECT_NEAR(radius, wheel.radius(1e-9 * w), 1e-6) << w;
    for (auto to = std::next(outline.begin()), from = outline.begin(); to != outline.end(); from = to++) {
      EXPECT_NEAR((from->second + to->second) / 2, wheel.radius(1e-9 * (from->first + to->first) / 2), 0.3e-3);
    }
  }
  EXPECT_EQ(outlineOf(WheelProfile::angled(0.1, 0.006, 0.5)).size(), 2u) << "each costs time in every frame";
}

/// Six times the volume of closed triangles that face outward is positive.
TEST(FirstView, TheBlankIsClosedAndFacesOutward) {
  double volume = 0;
  for (const Marker& m : firstViewMarkers({0.08, 0.006, 0.012, 0.05}).markers) {
    for (std::size_t i = 0; m.ns == "blank" && i + 2 < m.points.size(); i += 3) {
      const auto &a = m.points[i], &b = m.points[i + 1], &c = m.points[i + 2];
      volume += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
    }
  }
  EXPECT_NEAR(volume / 6, M_PI * 0.006 * 0.006 * 0.05, 1e-3 * M_PI * 0.006 * 0.006 * 0.05);
}

}  // namespace test_first_view
}  // namespace grinder
