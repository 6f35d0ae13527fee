#include "flute_grinder/scene/markers.h"

#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>

namespace grinder {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point p;
  p.x = x;
  p.y = y;
  p.z = z;
  return p;
}

std_msgs::ColorRGBA colour(double r, double g, double b, double a) {
  std_msgs::ColorRGBA c;
  c.r = static_cast<float>(r);
  c.g = static_cast<float>(g);
  c.b = static_cast<float>(b);
  c.a = static_cast<float>(a);
  return c;
}

std_msgs::ColorRGBA heat(double fraction) {
  const double f = std::clamp(fraction, 0.0, 1.0);
  return colour(std::clamp(4 * f - 1.5, 0.1, 1.0), std::clamp(1.6 - std::abs(4 * f - 2), 0.1, 1.0),
                std::clamp(1.5 - 3 * f, 0.1, 1.0));
}

MarkerArray clearedArray() {
  MarkerArray array;
  array.markers.emplace_back().action = Marker::DELETEALL;
  return array;
}

Marker& append(MarkerArray& array, const char* ns, int type, const char* frame) {
  const auto id = static_cast<int>(array.markers.size());
  Marker& m = array.markers.emplace_back();
  m.header.frame_id = frame;
  m.ns = ns;
  m.id = id;
  m.type = type;
  m.action = Marker::ADD;
  m.pose.orientation.w = 1;
  m.scale.x = m.scale.y = m.scale.z = 1;
  m.color = colour(1, 1, 1);
  m.frame_locked = true;
  return m;
}

Marker& appendLines(MarkerArray& array, const char* ns, int type, const char* frame, double width) {
  Marker& m = append(array, ns, type, frame);
  m.scale.x = width;
  m.scale.y = m.scale.z = 0;  // rviz 1.14.4 warns about any other value
  return m;
}

Marker& appendSolid(MarkerArray& array, const char* ns, const char* frame, const std::vector<OutlinePoint>& outline,
                    const std_msgs::ColorRGBA& colour) {
  constexpr int segments = 180;  // 2 degrees each: error of 0.15 per mille of the radius, so no corners show
  const auto at = [](const OutlinePoint& p, int i) {
    const double angle = 2 * units::kPi * (i % segments) / segments;
    return point(p.x, p.radius * std::cos(angle), p.radius * std::sin(angle));
  };
  Marker& m = append(array, ns, Marker::TRIANGLE_LIST, frame);
  m.color = colour;
  for (std::size_t section = 0; section + 1 < outline.size(); ++section) {
    const OutlinePoint& from = outline[section];
    const OutlinePoint& to = outline[section + 1];
    for (int i = 0; i < segments; ++i) {
      // On the axis one edge of the quadrilateral shrinks to a point.
      if (from.radius > 0) m.points.insert(m.points.end(), {at(from, i), at(from, i + 1), at(to, i)});
      if (to.radius > 0) m.points.insert(m.points.end(), {at(from, i + 1), at(to, i + 1), at(to, i)});
    }
  }
  return m;
}

}  // namespace grinder
