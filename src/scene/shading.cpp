#include "scene/shading.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace grinder {

namespace {

constexpr double kSamePlace = 1e-8;  ///< corners within the same cell of this size are the same [m]
constexpr double kCosEdge = 0.77;    ///< cosine of the angle from which two facets meet at an edge
constexpr double kSliver = 1e-3;  ///< area, as a fraction of the largest beside it, below which a normal means nothing

constexpr double kAmbient = 0.36;  ///< light that comes from everywhere

struct Light {
  Eigen::Vector3d toward;
  double strength;
};

/// Around the axis, before the tool's end, so that no side of the tool is black wherever A is.
const std::array<Light, 3>& lights() {
  static const std::array<Light, 3> all = [] {
    std::array<Light, 3> made{{{{-0.6, -0.45, 0.9}, 0.52}, {{-0.5, -0.5, -0.9}, 0.26}, {{-0.4, 1, 0}, 0.34}}};
    for (Light& light : made) light.toward.normalize();
    return made;
  }();
  return all;
}

using Cell = std::array<std::int64_t, 3>;

Cell cellOf(const Eigen::Vector3d& at) {
  return {std::llround(at.x() / kSamePlace), std::llround(at.y() / kSamePlace), std::llround(at.z() / kSamePlace)};
}

}  // namespace

std::vector<Eigen::Vector3d> smoothNormals(const std::vector<Eigen::Vector3d>& corners) {
  std::vector<Eigen::Vector3d> areas(corners.size() / 3);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    areas[i] = (corners[3 * i + 1] - corners[3 * i]).cross(corners[3 * i + 2] - corners[3 * i]);
  }
  std::vector<Cell> cells(corners.size());
  std::transform(corners.begin(), corners.end(), cells.begin(), cellOf);
  std::vector<std::size_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cells[a] < cells[b]; });
  std::vector<Eigen::Vector3d> normals(corners.size());
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin, order.end(), [&](std::size_t i) { return cells[i] != cells[*begin]; });
    double largest = 0;
    for (auto i = begin; i != end; ++i) largest = std::max(largest, areas[*i / 3].norm());
    for (auto i = begin; i != end; ++i) {
      const Eigen::Vector3d& own = areas[*i / 3];
      const bool is_sliver = own.norm() <= kSliver * largest;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (auto k = begin; k != end; ++k) {
        const Eigen::Vector3d& other = areas[*k / 3];
        if (is_sliver || own.dot(other) >= kCosEdge * own.norm() * other.norm()) sum += other;
      }
      normals[*i] = sum.normalized();
    }
    begin = end;
  }
  return normals;
}

std_msgs::ColorRGBA lit(const std_msgs::ColorRGBA& colour, const Eigen::Vector3d& normal) {
  double light = kAmbient;
  for (const Light& one : lights()) light += one.strength * std::max(0.0, one.toward.dot(normal));
  std_msgs::ColorRGBA seen = colour;
  for (float* part : {&seen.r, &seen.g, &seen.b}) *part = static_cast<float>(std::min(1.0, *part * light));
  return seen;
}

}  // namespace grinder
