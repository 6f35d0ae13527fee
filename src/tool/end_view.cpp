#include "flute_grinder/tool/end_view.h"

#include "flute_grinder/tool/cutter_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace grinder {

namespace {

using Eigen::Vector2d;

constexpr double kStraight = 1e-8;  ///< distance up to which a corner is on the line of its neighbours [m]
constexpr double kSliver = 1e-11;   ///< area up to which an outline is that of slivers [m^2]
/// Distance of a line's ends up to which it is no edge: near the axis, the rims of other flanks, which pass it by as
/// much, cut through rake face and flank [m].
constexpr double kNoEdge = 50e-6;
constexpr SolidResolution kResolution{24, 24, 144};

/// A corner by its place: corners that coincide are exactly equal.
using Corner = std::array<double, 3>;
using Side = std::pair<Corner, Corner>;  ///< of a triangle, with the face on its left
/// The line that leaves each corner.
using Chains = std::multimap<Corner, Corner>;

/// What a face of the solid belongs to.
struct Face {
  SurfaceKind kind;
  std::uint16_t tooth;
};

using Faces = std::map<Side, Face>;

bool operator<(const Face& a, const Face& b) { return std::pair(a.kind, a.tooth) < std::pair(b.kind, b.tooth); }

bool isOnEnd(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kEndFace:
    case SurfaceKind::kGash:
    case SurfaceKind::kEndPrimary:
    case SurfaceKind::kEndSecondary:
    case SurfaceKind::kChamfer: return true;
    default: return false;
  }
}

bool isFlank(const Face& face) { return face.kind == SurfaceKind::kEndPrimary || face.kind == SurfaceKind::kChamfer; }

bool isRakeFace(const Face& face) { return face.kind == SurfaceKind::kGash || face.kind == SurfaceKind::kRakeFace; }

template <typename Visit>
void forEachSide(const CutterSolid& solid, const SolidTriangle& triangle, const Visit& visit) {
  const auto corner = [&](std::size_t i) {
    const Eigen::Vector3d& at = solid.vertices[triangle.vertices[i % 3]];
    return Corner{at.x(), at.y(), at.z()};
  };
  for (std::size_t i = 0; i < 3; ++i) visit(corner(i), corner(i + 1));
}

/// The faces that can form an edge, beside the sides of their triangles.
Faces facesOf(const CutterSolid& solid) {
  Faces faces;
  for (const SolidTriangle& t : solid.triangles) {
    const Face face{t.kind, t.tooth};
    if (!isFlank(face) && !isRakeFace(face)) continue;
    forEachSide(solid, t, [&](const Corner& from, const Corner& to) { faces.emplace(Side(from, to), face); });
  }
  return faces;
}

/// Seen along the axis, without corners on straight lines.
EndPolyline projected(const std::vector<Corner>& corners) {
  EndPolyline line;
  for (const Corner& corner : corners) {
    const Vector2d next(corner[1], corner[2]);
    while (line.size() > 1) {
      const Vector2d from = line[line.size() - 2], along = next - from, to = line.back() - from;
      const double off = std::abs(along.x() * to.y() - along.y() * to.x());
      if (!(off <= kStraight * along.norm() && along.dot(to) >= 0)) break;
      line.pop_back();
    }
    line.push_back(next);
  }
  return line;
}

double areaOf(const EndPolyline& outline) {
  double twice = 0;
  for (std::size_t i = 1; i < outline.size(); ++i) {
    twice += outline[i - 1].x() * outline[i].y() - outline[i - 1].y() * outline[i].x();
  }
  return twice / 2;
}

/// Takes a line out of the chains.
std::vector<Corner> take(Chains& chains, const Corner& begin) {
  std::vector<Corner> line{begin};
  for (auto next = chains.find(begin); next != chains.end(); next = chains.find(line.back())) {
    line.push_back(next->second);
    chains.erase(next);
    if (line.back() == begin) break;
  }
  return line;
}

/// A corner at which no other line ends, or any corner of closed lines.
Corner beginOf(const Chains& chains) {
  const auto is_begin = [&](const auto& chain) {
    return std::none_of(chains.begin(), chains.end(), [&](const auto& other) { return other.second == chain.first; });
  };
  const auto begin = std::find_if(chains.begin(), chains.end(), is_begin);
  return begin == chains.end() ? chains.begin()->first : begin->first;
}

/// The borders of what is left of the blank's end, and of what the volumes leave. A part that faces away from the end
/// hides what it covers: both are within their common border in opposite senses.
std::map<Face, Chains> bordersOf(const CutterSolid& solid, double blank_x) {
  std::map<Face, std::map<Side, int>> passed;
  for (const SolidTriangle& t : solid.triangles) {
    if (!isOnEnd(t.kind)) continue;
    const bool is_blank = t.kind == SurfaceKind::kEndFace;
    if (is_blank && solid.vertices[t.vertices[0]].x() > blank_x) continue;
    std::map<Side, int>& of_face = passed[{t.kind, is_blank ? std::uint16_t{0} : t.tooth}];
    forEachSide(solid, t, [&](const Corner& from, const Corner& to) {
      from < to ? ++of_face[{from, to}] : --of_face[{to, from}];
    });
  }
  std::map<Face, Chains> borders;
  for (const auto& [face, sides] : passed) {
    for (const auto& [side, times] : sides) {
      for (int i = 0; i < times; ++i) borders[face].emplace(side.first, side.second);
      for (int i = 0; i > times; --i) borders[face].emplace(side.second, side.first);
    }
  }
  return borders;
}

std::vector<EndRegion> regionsOf(std::map<Face, Chains> borders) {
  std::vector<std::pair<double, EndRegion>> by_depth;
  for (auto& [face, chains] : borders) {
    double sum = 0;
    for (const auto& chain : chains) sum += chain.first[0];
    auto& [depth, region] = by_depth.emplace_back();
    depth = sum / static_cast<double>(chains.size());
    region = {face.kind, face.tooth, {}};
    while (!chains.empty()) {
      EndPolyline outline = projected(take(chains, chains.begin()->first));
      if (std::abs(areaOf(outline)) > kSliver) region.outlines.push_back(std::move(outline));
    }
    if (region.outlines.empty()) by_depth.pop_back();
  }
  std::stable_sort(by_depth.begin(), by_depth.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<EndRegion> regions;
  for (auto& [depth, region] : by_depth) regions.push_back(std::move(region));
  return regions;
}

std::vector<EndEdge> edgesOf(const Faces& faces) {
  std::map<std::uint16_t, Chains> of_teeth;
  for (const auto& [side, face] : faces) {
    if (!isFlank(face)) continue;
    const auto beyond = faces.find({side.second, side.first});
    if (beyond == faces.end() || !isRakeFace(beyond->second) || beyond->second.tooth != face.tooth) continue;
    of_teeth[face.tooth].emplace(side.first, side.second);
  }
  std::vector<EndEdge> edges;
  for (auto& [tooth, chains] : of_teeth) {
    while (!chains.empty()) {
      EndPolyline line = projected(take(chains, beginOf(chains)));
      if ((line.front() - line.back()).norm() <= kNoEdge) continue;
      if (line.front().norm() > line.back().norm()) std::reverse(line.begin(), line.end());
      edges.push_back({tooth, std::move(line)});
    }
  }
  return edges;
}

}  // namespace

EndView endView(const GroundCutter& cutter, const EndVolumes& end) {
  if (end.removed.empty()) return {};
  const double to = 2 * cutter.cutter().radius(0);  // beyond the gashes
  const CutterSolid solid = cutterSolid(cutter, {end.blank_x, to}, kResolution, end.removed);
  return {regionsOf(bordersOf(solid, end.blank_x)), edgesOf(facesOf(solid))};
}

}  // namespace grinder
