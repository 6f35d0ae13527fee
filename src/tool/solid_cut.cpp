#include "tool/solid_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grinder {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kSides = 63;                      ///< planes of a volume that have a bit of their own
constexpr std::uint64_t kOtherPlanes = 1ull << kSides;  ///< the bit of all other planes
/// The rounding of a corner is the larger, the more nearly parallel its planes are [m].
constexpr double kRounding = 1e-6;
constexpr double kSamePlane = 1e-11;  ///< difference between planes that are the same [m], [1]

/// The planes that bound a convex part of a box.
/// @param part gets the part in front of all planes.
std::vector<Plane> needed(const std::vector<Plane>& planes, ConvexPart& part) {
  std::vector<Plane> result;
  for (const Plane& plane : planes) {
    if (!part.isEmpty() && part.cut(plane)) result.push_back(plane);
  }
  const auto is_idle = [&](const Plane& plane) { return !part.hasFaceOn(plane); };
  result.erase(std::remove_if(result.begin(), result.end(), is_idle), result.end());
  return result;
}

std::vector<Plane> turned(std::vector<Plane> planes) {
  for (Plane& plane : planes) plane = {-plane.normal, -plane.offset};
  return planes;
}

/// The part of a volume in a box, with the planes that it needs there; nothing if there is no part.
/// @param bounds gets the box about its body.
std::optional<RemovedVolume> within(const RemovedVolume& volume, const Box& box, Box& bounds) {
  ConvexPart body(box);
  RemovedVolume result{needed(volume.body, body), {}, volume.kind, volume.tooth};
  if (body.isEmpty()) return std::nullopt;
  bounds = body.bounds();
  if (volume.hollow.empty()) return result;
  ConvexPart hollow(bounds);
  result.hollow = turned(needed(turned(volume.hollow), hollow));
  if (hollow.isEmpty()) {
    result.hollow.clear();
  } else if (result.hollow.empty()) {
    return std::nullopt;
  }
  return result;
}

/// The part of a polygon in front of all planes, or behind them all. What is not there is added to the rest.
Polygon split(Polygon polygon, const std::vector<Plane>& planes, bool in_front, std::vector<Polygon>& rest) {
  for (const Plane& plane : planes) {
    Polygon off = clipped(polygon, plane, !in_front);
    if (off.empty()) continue;
    polygon = clipped(polygon, plane, in_front);
    rest.push_back(std::move(off));
    if (polygon.empty()) break;
  }
  return polygon;
}

/// Adds the parts of a polygon outside a volume.
void addOutside(const Polygon& polygon, const RemovedVolume& volume, std::vector<Polygon>& all) {
  std::vector<Polygon> rest;
  Polygon inside = split(polygon, volume.body, true, rest);
  if (!inside.empty() && !volume.hollow.empty()) {
    std::vector<Polygon> removed;
    Polygon stays = split(std::move(inside), volume.hollow, false, removed);
    if (!stays.empty()) rest.push_back(std::move(stays));
    inside = removed.empty() ? Polygon() : std::move(removed.front());
  }
  if (inside.empty()) {
    all.push_back(polygon);
    return;
  }
  for (Polygon& part : rest) all.push_back(std::move(part));
}

bool isSame(const Plane& a, const Plane& b) {
  return (a.normal - b.normal).norm() <= kSamePlane && std::abs(a.offset - b.offset) <= kSamePlane;
}

bool hasPlane(const RemovedVolume& volume, const Plane& plane) {
  return std::any_of(volume.body.begin(), volume.body.end(), [&](const Plane& own) { return isSame(own, plane); });
}

RemovedVolume without(const Plane& plane, RemovedVolume volume) {
  const auto is_same = [&](const Plane& own) { return isSame(own, plane); };
  volume.body.erase(std::remove_if(volume.body.begin(), volume.body.end(), is_same), volume.body.end());
  return volume;
}

}  // namespace

SolidCut::SolidCut(const std::vector<RemovedVolume>& volumes, const Box& box)
    : reach_(-std::numeric_limits<double>::infinity()) {
  for (const RemovedVolume& volume : volumes) {
    Box bounds;
    std::optional<RemovedVolume> part = within(volume, box, bounds);
    if (!part) continue;
    reach_ = std::max(reach_, bounds.most[0]);
    volumes_.push_back(*std::move(part));
    reaches_.push_back({bounds.least[0] - kRounding, bounds.most[0] + kRounding});
  }
}

SolidCut::Volumes SolidCut::between(double from, double to) const {
  Volumes found;
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    if (reaches_[i].from <= to && reaches_[i].to >= from) found.push_back(i);
  }
  return found;
}

void SolidCut::findSides(const Volumes& of, const Vector3d& at, std::uint64_t* sides) const noexcept {
  for (const std::size_t i : of) {
    const RemovedVolume& volume = volumes_[i];
    std::uint64_t behind = volume.hollow.empty() ? 0 : kOtherPlanes;
    for (std::size_t k = 0; k < volume.body.size(); ++k) {
      if (!(volume.body[k].height(at) > 0)) behind |= k < kSides ? 1ull << k : kOtherPlanes;
    }
    *sides++ = behind;
  }
}

std::optional<SolidCut::Volumes> SolidCut::touched(const Volumes& of,
                                                   std::initializer_list<const std::uint64_t*> corners) {
  Volumes found;
  for (std::size_t i = 0; i < of.size(); ++i) {
    std::uint64_t all = ~kOtherPlanes, any = 0;
    for (const std::uint64_t* corner : corners) {
      all &= corner[i];
      any |= corner[i];
    }
    if (any == 0) return std::nullopt;
    if (all == 0) found.push_back(of[i]);
  }
  return found;
}

std::vector<Polygon> SolidCut::outside(const Volumes& touched, Polygon triangle) const {
  std::vector<Polygon> left{std::move(triangle)};
  for (const std::size_t i : touched) {
    std::vector<Polygon> next;
    for (const Polygon& polygon : left) addOutside(polygon, volumes_[i], next);
    left = std::move(next);
  }
  return left;
}

void SolidCut::addFaces(const Volumes& touched, const TetrahedronCorners& tetrahedron,
                        std::vector<CutFace>& faces) const {
  for (const std::size_t i : touched) addFacesOf(i, touched, tetrahedron, faces);
}

void SolidCut::addFacesOf(std::size_t volume, const Volumes& touched, const TetrahedronCorners& tetrahedron,
                          std::vector<CutFace>& faces) const {
  const RemovedVolume& own = volumes_[volume];
  RemovedVolume reduced;
  const auto take = [&](const Plane& plane, std::vector<Polygon> left) {
    for (const std::size_t i : touched) {
      if (i == volume || left.empty()) continue;
      // Of two volumes with the same plane, the first leaves the face.
      const bool same = hasPlane(volumes_[i], plane);
      if (same && i > volume) continue;
      const RemovedVolume& other = same ? (reduced = without(plane, volumes_[i])) : volumes_[i];
      std::vector<Polygon> next;
      for (const Polygon& polygon : left) addOutside(polygon, other, next);
      left = std::move(next);
    }
    for (Polygon& polygon : left) faces.push_back({std::move(polygon), own.kind, own.tooth});
  };
  const auto inside = [](Polygon polygon, const std::vector<Plane>& planes, const Plane& but, bool in_front) {
    for (const Plane& plane : planes) {
      if (polygon.empty()) break;
      if (&plane != &but) polygon = clipped(polygon, plane, in_front);
    }
    return polygon;
  };
  for (const Plane& plane : own.body) {
    Polygon face = inside(section(tetrahedron, plane), own.body, plane, true);
    if (face.empty()) continue;
    std::vector<Polygon> left;
    const bool is_whole = own.hollow.empty() || split(face, own.hollow, false, left).empty();
    if (is_whole) left = {std::move(face)};
    take(plane, std::move(left));
  }
  for (const Plane& plane : own.hollow) {
    Polygon face = inside(inside(section(tetrahedron, plane), own.hollow, plane, false), own.body, plane, true);
    if (!face.empty()) take(plane, {std::move(face)});
  }
}

}  // namespace grinder
