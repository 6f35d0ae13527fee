#include "flute_grinder/scene/markers.h"

#include "flute_grinder/base/units.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace grinder {

namespace {

/// The scale viridis at equal distances, without its darkest fifth, which shaded would be black: red, green, blue.
constexpr std::array<std::array<double, 3>, 9> kViridis{{{0.254, 0.265, 0.530},
                                                         {0.207, 0.372, 0.553},
                                                         {0.164, 0.471, 0.558},
                                                         {0.128, 0.567, 0.551},
                                                         {0.135, 0.659, 0.518},
                                                         {0.267, 0.749, 0.441},
                                                         {0.478, 0.821, 0.318},
                                                         {0.741, 0.873, 0.150},
                                                         {0.993, 0.906, 0.144}}};

}  // namespace

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

std_msgs::ColorRGBA errorColour(double fraction) {
  if (!(fraction <= 1)) return colour(0.86, 0.08, 0.10);
  constexpr std::size_t steps = kViridis.size() - 1;
  const double at = std::max(fraction, 0.0) * steps;
  const std::size_t i = std::min(static_cast<std::size_t>(at), steps - 1);
  const auto part = [&](std::size_t k) {
    return kViridis[i][k] + (at - static_cast<double>(i)) * (kViridis[i + 1][k] - kViridis[i][k]);
  };
  return colour(part(0), part(1), part(2));
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
