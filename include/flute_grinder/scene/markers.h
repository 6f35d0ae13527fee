#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <vector>

/// @file
/// Building blocks of the markers for rviz.
namespace grinder {

/// The maximum number of points in one marker: rviz crashes on a line strip of more than 16,384.
constexpr std::size_t kMaxMarkerPoints = 16000;

/// The namespace of the surface of a wedge of the ground cutter; hidden, the cutter is cut open.
constexpr const char* kCutOut = "cut_out";

geometry_msgs::Point point(double x, double y, double z);

/// Red, green, blue and opacity, 0 to 1 each.
std_msgs::ColorRGBA colour(double r, double g, double b, double a = 1);

/// The colour of an error: from blue at 0 through green to yellow at 1, on the viridis scale, which colour-blind people
/// can read too; red beyond 1.
/// @param fraction error as a fraction of its tolerance.
std_msgs::ColorRGBA errorColour(double fraction);

/// An array whose first marker deletes everything shown on its topic before.
visualization_msgs::MarkerArray clearedArray();

/// Appends a white marker with a unique id, at the origin of its frame and moving with it.
/// @param type type, e.g. visualization_msgs::Marker::LINE_STRIP.
/// @return the marker; valid until the next one is appended.
visualization_msgs::Marker& append(visualization_msgs::MarkerArray& array, const char* ns, int type, const char* frame);

/// Appends a marker for lines.
/// @param type visualization_msgs::Marker::LINE_STRIP or LINE_LIST.
/// @param width width of the lines [m].
visualization_msgs::Marker& appendLines(visualization_msgs::MarkerArray& array, const char* ns, int type,
                                        const char* frame, double width);

/// A corner of the outline of a solid of revolution.
struct OutlinePoint {
  double x;       ///< distance along the axis [m]
  double radius;  ///< distance from the axis [m]
};

/// Appends a solid of revolution about the frame's X axis, as triangles that face outward where the outline runs toward
/// +X away from the axis. In a single colour, since rviz does not light markers with a colour per point.
visualization_msgs::Marker& appendSolid(visualization_msgs::MarkerArray& array, const char* ns, const char* frame,
                                        const std::vector<OutlinePoint>& outline, const std_msgs::ColorRGBA& colour);

}  // namespace grinder
