#include "flute_grinder/scene/first_view.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kHub = 0.84;       ///< radius of the wheel's body, as a fraction of the rim's radius
constexpr double kStraight = 1e-7;  ///< distance from a line within which a point is on it [m]
constexpr int kProfileSteps = 48;   ///< steps of the rim's outline

/// Appends a point to an outline. If the outline goes straight on, the point before it is dropped: each point costs
/// time in every frame.
void appendCorner(std::vector<OutlinePoint>& outline, const OutlinePoint& next) {
  if (outline.size() >= 2) {
    const OutlinePoint &a = outline[outline.size() - 2], &b = outline.back();
    const double dx = next.x - a.x, dr = next.radius - a.radius;
    const double off = std::abs((b.x - a.x) * dr - (b.radius - a.radius) * dx);
    if (off <= kStraight * std::hypot(dx, dr)) outline.pop_back();
  }
  outline.push_back(next);
}

}  // namespace

void appendWheel(MarkerArray& array, const WheelProfile& wheel) {
  const double hub = kHub * wheel.maxRadius();
  const double lower = wheel.lowerFace(), upper = wheel.upperFace();
  const auto add = [&](const std::vector<OutlinePoint>& outline, const std_msgs::ColorRGBA& colour) {
    Marker& m = appendSolid(array, "wheel", "wheel", outline, colour);
    m.pose.orientation.y = -std::sqrt(0.5);
    m.pose.orientation.w = std::sqrt(0.5);
  };
  std::vector<OutlinePoint> rim{{lower, hub}};
  for (int i = 0; i <= kProfileSteps; ++i) {
    const double w = lower + (upper - lower) * i / kProfileSteps;
    appendCorner(rim, {w, std::max(hub, wheel.radius(w))});
  }
  rim.push_back({upper, hub});
  add(rim, colour(0.66, 0.45, 0.30));
  add({{lower, 0}, {lower, hub}}, colour(0.74, 0.75, 0.77));
  add({{upper, hub}, {upper, 0}}, colour(0.74, 0.75, 0.77));
}

MarkerArray firstViewMarkers(const FirstView& view) {
  MarkerArray array = clearedArray();
  appendWheel(array, WheelProfile::straight(view.wheel_diameter, view.wheel_width));
  const double length = view.blank_length, radius = view.blank_diameter / 2;
  appendSolid(array, "blank", "cutter", {{0, 0}, {0, radius}, {length, radius}, {length, 0}}, colour(0.74, 0.75, 0.77));
  return array;
}

}  // namespace grinder
