#include "tool/seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace grinder {

namespace {

using Eigen::Vector3d;

/// Distances up to which corners are one, and one is on an edge [m]: the least with which the solid closes. The
/// rounding of a corner is the larger, the more nearly parallel its planes are.
constexpr double kSamePoint[] = {1e-9, 1e-8, 1e-7, 1e-6};
constexpr int kRounds = 4;  ///< an edge that is divided may come to lie on others
constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Finds the first of the points that are one.
class Welder {
 public:
  /// @param same distance up to which points are one [m].
  Welder(std::size_t points, double same) : same_(same), cell_(64 * same) {
    std::size_t drawers = 1;
    while (drawers < points) drawers *= 2;
    last_.resize(drawers, kNoVertex);
    points_.reserve(points);
    before_.reserve(points);
  }

  std::uint32_t add(const Vector3d& point) {
    const std::array<std::int64_t, 3> cell = cellOf(point);
    // A point of another cell can be the same only beyond the nearer side of each axis.
    std::array<std::int64_t, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double place = point[static_cast<Eigen::Index>(i)] / cell_ - static_cast<double>(cell[i]);
      side[i] = place < same_ / cell_ ? -1 : place > 1 - same_ / cell_ ? 1 : 0;
    }
    for (int corner = 0; corner < 8; ++corner) {
      std::array<std::int64_t, 3> other = cell;
      bool is_new = true;
      for (std::size_t i = 0; i < 3; ++i) {
        if ((corner >> i & 1) == 0) continue;
        other[i] += side[i];
        is_new = is_new && side[i] != 0;
      }
      const std::uint32_t found = is_new ? find(other, point) : kNoVertex;
      if (found != kNoVertex) return found;
    }
    const auto index = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    before_.push_back(std::exchange(last_[drawerOf(cell)], index));
    return index;
  }

  std::vector<Vector3d> take() { return std::move(points_); }

 private:
  std::array<std::int64_t, 3> cellOf(const Vector3d& point) const {
    return {static_cast<std::int64_t>(std::floor(point[0] / cell_)),
            static_cast<std::int64_t>(std::floor(point[1] / cell_)),
            static_cast<std::int64_t>(std::floor(point[2] / cell_))};
  }
  /// Cells may share one.
  std::size_t drawerOf(const std::array<std::int64_t, 3>& cell) const {
    std::uint64_t key = 0;
    for (const std::int64_t part : cell) {
      key = (key ^ static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15u;
      key ^= key >> 29;
    }
    return key & (last_.size() - 1);
  }
  std::uint32_t find(const std::array<std::int64_t, 3>& cell, const Vector3d& point) const {
    for (std::uint32_t i = last_[drawerOf(cell)]; i != kNoVertex; i = before_[i]) {
      if ((points_[i] - point).cwiseAbs().maxCoeff() <= same_) return i;
    }
    return kNoVertex;
  }

  double same_, cell_;
  std::vector<Vector3d> points_;
  std::vector<std::uint32_t> last_;    ///< last point of each drawer; their number is a power of two
  std::vector<std::uint32_t> before_;  ///< of each point, the one before it in its drawer
};

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge sorted(std::uint32_t a, std::uint32_t b) { return a < b ? Edge(a, b) : Edge(b, a); }

/// The edges that are not passed as often in one direction as in the other, in order.
std::vector<Edge> openEdges(const CutterSolid& solid) {
  // The passed edges, by their lower corner: it has the other corner, and the direction in the lowest bit.
  std::vector<std::size_t> end(solid.vertices.size() + 1);
  const auto visit = [&](const auto& take) {
    for (const SolidTriangle& t : solid.triangles) {
      for (std::size_t i = 0; i < 3; ++i) take(t.vertices[i], t.vertices[(i + 1) % 3]);
    }
  };
  visit([&](std::uint32_t a, std::uint32_t b) { ++end[std::min(a, b) + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<std::size_t> next(end.begin(), std::prev(end.end()));
  std::vector<std::uint64_t> passed(end.back());
  visit([&](std::uint32_t a, std::uint32_t b) {
    passed[next[std::min(a, b)]++] = std::uint64_t{std::max(a, b)} << 1 | (a < b ? 1u : 0u);
  });
  std::vector<Edge> open;
  for (std::uint32_t corner = 0; corner + 1 < end.size(); ++corner) {
    const auto begin = passed.begin() + static_cast<std::ptrdiff_t>(end[corner]);
    const auto last = passed.begin() + static_cast<std::ptrdiff_t>(end[corner + 1]);
    std::sort(begin, last);
    for (auto i = begin; i != last;) {
      const std::uint64_t other = *i >> 1;
      int times = 0;
      for (; i != last && *i >> 1 == other; ++i) times += (*i & 1) != 0 ? 1 : -1;
      if (times != 0) open.emplace_back(corner, static_cast<std::uint32_t>(other));
    }
  }
  return open;
}

/// The corners that lie on open edges.
class Dividers {
 public:
  /// @param same distance up to which a corner is on an edge [m].
  Dividers(const CutterSolid& solid, const std::vector<Edge>& open, double same) : at_(solid.vertices), same_(same) {
    for (const Edge& edge : open) {
      corners_.push_back(edge.first);
      corners_.push_back(edge.second);
    }
    std::sort(corners_.begin(), corners_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(at_[a].x(), a) < std::pair(at_[b].x(), b); });
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  }

  /// From the edge's first corner to its second.
  std::vector<std::uint32_t> on(const Edge& edge) const {
    const Vector3d& from = at_[edge.first];
    const Vector3d way = at_[edge.second] - from;
    const double length = way.norm();
    const double least = std::min(from.x(), from.x() + way.x()) - same_;
    const double most = std::max(from.x(), from.x() + way.x()) + same_;
    std::vector<std::pair<double, std::uint32_t>> found;
    auto i = std::lower_bound(corners_.begin(), corners_.end(), least,
                              [&](std::uint32_t corner, double x) { return at_[corner].x() < x; });
    for (; i != corners_.end() && at_[*i].x() <= most; ++i) {
      const Vector3d off = at_[*i] - from;
      const double along = off.dot(way) / length;
      if (*i == edge.first || *i == edge.second || !(along > 0 && along < length)) continue;
      if ((off - along / length * way).norm() <= same_) found.emplace_back(along, *i);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> corners;
    for (const auto& [along, corner] : found) corners.push_back(corner);
    return corners;
  }

 private:
  const std::vector<Vector3d>& at_;
  const double same_;
  std::vector<std::uint32_t> corners_;  ///< by X
};

void push(std::vector<SolidTriangle>& all, const SolidTriangle& like, const std::array<std::uint32_t, 3>& v) {
  if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return;
  all.push_back({v, like.kind, like.tooth});
}

/// Divides triangles at the corners on their open edges, one edge of each.
/// @return whether there was any.
bool divide(CutterSolid& solid, const std::vector<Edge>& open, double same) {
  const Dividers dividers(solid, open, same);
  std::vector<std::vector<std::uint32_t>> on(open.size());
  for (std::size_t i = 0; i < open.size(); ++i) on[i] = dividers.on(open[i]);
  std::vector<SolidTriangle> divided;
  divided.reserve(solid.triangles.size());
  bool any = false;
  for (const SolidTriangle& t : solid.triangles) {
    std::size_t side = 0;
    std::vector<std::uint32_t> corners;
    for (; side < 3 && corners.empty(); ++side) {
      const std::uint32_t a = t.vertices[side], b = t.vertices[(side + 1) % 3];
      const Edge edge = sorted(a, b);
      const auto found = std::lower_bound(open.begin(), open.end(), edge);
      if (found == open.end() || *found != edge) continue;
      corners = on[static_cast<std::size_t>(found - open.begin())];
      if (a > b) std::reverse(corners.begin(), corners.end());
    }
    if (corners.empty()) {
      divided.push_back(t);
      continue;
    }
    any = true;
    const std::uint32_t apex = t.vertices[(side + 1) % 3];
    std::uint32_t last = t.vertices[side - 1];
    corners.push_back(t.vertices[side % 3]);
    for (const std::uint32_t corner : corners) {
      push(divided, t, {last, corner, apex});
      last = corner;
    }
  }
  solid.triangles = std::move(divided);
  return any;
}

/// Leaves what hangs together with the end of the shank: elsewhere, cuts can leave a chip that falls off.
void dropChips(CutterSolid& solid) {
  std::vector<std::uint32_t> parent(solid.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const SolidTriangle& t : solid.triangles) {
    for (std::size_t i = 1; i < 3; ++i) parent[root(t.vertices[i])] = root(t.vertices[0]);
  }
  const auto farther = [](const Vector3d& a, const Vector3d& b) { return a.x() < b.x(); };
  const auto shank = std::max_element(solid.vertices.begin(), solid.vertices.end(), farther);
  if (shank == solid.vertices.end()) return;
  const std::uint32_t whole = root(static_cast<std::uint32_t>(shank - solid.vertices.begin()));
  const auto is_chip = [&](const SolidTriangle& t) { return root(t.vertices[0]) != whole; };
  solid.triangles.erase(std::remove_if(solid.triangles.begin(), solid.triangles.end(), is_chip), solid.triangles.end());
}

/// Makes one corner of those that are the same.
void weld(CutterSolid& solid, double same) {
  Welder welder(solid.vertices.size(), same);
  std::vector<std::uint32_t> index(solid.vertices.size(), kNoVertex);
  std::vector<SolidTriangle> triangles;
  triangles.reserve(solid.triangles.size());
  for (const SolidTriangle& t : solid.triangles) {
    std::array<std::uint32_t, 3> v{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& known = index[t.vertices[i]];
      if (known == kNoVertex) known = welder.add(solid.vertices[t.vertices[i]]);
      v[i] = known;
    }
    push(triangles, t, v);
  }
  solid.vertices = welder.take();
  solid.triangles = std::move(triangles);
}

/// Joins what is the same. @return how many edges stay open.
std::size_t join(CutterSolid& solid, double same) {
  weld(solid, same);
  std::vector<Edge> open = openEdges(solid);
  for (int i = 0; i < kRounds && !open.empty() && divide(solid, open, same); ++i) open = openEdges(solid);
  return open.size();
}

}  // namespace

void closeSeams(CutterSolid& solid) {
  CutterSolid whole;
  for (const double same : kSamePoint) {
    if (join(solid, same) == 0) {
      dropChips(solid);  // without open edges each of them is closed, and so is the rest
      solid.open_edges = 0;
      return;
    }
    whole = solid;  // a chip may be what only the next distance joins
    dropChips(whole);
    whole.open_edges = openEdges(whole).size();
    if (whole.open_edges == 0) break;
  }
  solid = std::move(whole);
}

}  // namespace grinder
