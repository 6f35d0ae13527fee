#pragma once

#include <std_msgs/ColorRGBA.h>
#include <Eigen/Core>

#include <vector>

/// @file
/// Shading of triangles by the surface that they stand for. rviz lights a marker facet by facet, so that one sees the
/// facets, and a sliver of rounding errors is black; a marker with a colour for each point it shows as it is.
namespace grinder {

/// The unit normals at the corners of triangles: of a smooth surface where they meet at less than 40 degrees, and of
/// each by itself at an edge.
/// @param corners corners of the triangles, by threes, counterclockwise as seen from outside; coincident ones within
///        10 nm [m].
std::vector<Eigen::Vector3d> smoothNormals(const std::vector<Eigen::Vector3d>& corners);

/// How a surface of this colour looks lit by lamps that turn with the tool.
/// @param normal unit normal in the cutter's frame.
std_msgs::ColorRGBA lit(const std_msgs::ColorRGBA& colour, const Eigen::Vector3d& normal);

}  // namespace grinder
