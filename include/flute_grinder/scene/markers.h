#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <vector>

/// @file
/// What all markers for rviz are made of.
namespace flute_grinder {

/// The largest number of points in one marker: rviz crashes on a line strip of more than 16,384.
constexpr std::size_t kMaxMarkerPoints = 16000;

geometry_msgs::Point point(double x, double y, double z);

/// Red, green, blue, and how opaque, 0 to 1 each.
std_msgs::ColorRGBA colour(double r, double g, double b, double a = 1);

/// Blue at 0 over green and yellow to red at 1.
std_msgs::ColorRGBA heat(double fraction);

/// An array that begins by deleting what its topic has shown before.
visualization_msgs::MarkerArray startOver();

/// Appends a marker of its own number, white, at its frame's origin and moving with it.
/// @param type as visualization_msgs::Marker::LINE_STRIP.
/// @return the marker, until the next is appended.
visualization_msgs::Marker& append(visualization_msgs::MarkerArray& array, const char* ns, int type, const char* frame);

/// A corner of the outline of a solid of revolution.
struct OutlinePoint {
  double x;       ///< along the axis [m]
  double radius;  ///< [m]
};

/// Appends a solid of revolution about the frame's X axis, as triangles that face outward where the outline goes
/// toward +X outside of the axis. One colour each: rviz lights nothing that has colours point by point.
visualization_msgs::Marker& appendSolid(visualization_msgs::MarkerArray& array, const char* ns, const char* frame,
                                        const std::vector<OutlinePoint>& outline, const std_msgs::ColorRGBA& colour);

}  // namespace flute_grinder
