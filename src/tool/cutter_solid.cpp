#include "flute_grinder/tool/cutter_solid.h"

#include "flute_grinder/base/require.h"
#include "flute_grinder/base/units.h"
#include "tool/seams.h"
#include "tool/solid_cut.h"
#include "tool/solid_layers.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

OutlineGrid gridOf(const GroundCutter& cutter, const SolidResolution& resolution) {
  const std::vector<GroundTooth>& teeth = cutter.teeth();
  double widest = teeth.empty() ? 0 : units::kTurn + teeth.front().angle - teeth.back().angle;
  for (std::size_t i = 1; i < teeth.size(); ++i) widest = std::max(widest, teeth[i].angle - teeth[i - 1].angle);
  const double columns = std::ceil(widest / units::kTurn * static_cast<double>(resolution.around));
  return {teeth.size(), resolution.rings, std::max<std::size_t>(1, static_cast<std::size_t>(columns)),
          !cutter.reliefs(0).empty()};
}

/// Corners of a triangle, as indices of vertices.
using Triangle = std::array<std::uint32_t, 3>;

/// A section divided into triangles. Each body between two flutes has rings and columns, since an undercut wall hides
/// the axis from some of its points. There are points inside the outline, too.
class SectionMesh {
 public:
  SectionMesh(const OutlineGrid& grid, CutDirection direction) : grid_(grid), centre_(index(grid.teeth, 0, 1)) {
    for (std::size_t body = 0; body < grid.teeth; ++body) {
      tooth_.push_back(static_cast<std::uint16_t>(grid.tooth(grid.land(body, 0), direction)));
      for (std::size_t k = 0; k < grid.columns; ++k) add(centre_, at(body, 0, k), at(body, 0, k + 1));
      for (std::size_t ring = 0; ring < grid.rings; ++ring) {
        for (std::size_t k = 0; k < grid.columns; ++k) {
          add(at(body, ring, k), at(body, ring + 1, k), at(body, ring + 1, k + 1));
          add(at(body, ring, k), at(body, ring + 1, k + 1), at(body, ring, k + 1));
        }
      }
    }
  }

  /// Triangles, counterclockwise as seen from the shank, body by body.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::uint16_t toothOf(std::size_t triangle) const { return tooth_[triangle / (triangles_.size() / grid_.teeth)]; }

  /// The points of a section: its outline, then the points inside it, the centre last.
  std::vector<PolarPoint> points(const std::vector<PolarPoint>& outline) const {
    std::vector<PolarPoint> all = outline;
    for (std::size_t body = 0; body < grid_.teeth; ++body) {
      for (std::size_t ring = 0; ring < grid_.rings; ++ring) {
        const PolarPoint from = outline[grid_.high(body, ring)];
        PolarPoint to = outline[grid_.lowOfNext(body, ring)];
        if (ring == 0 && body + 1 == grid_.teeth) to.turns += 1;
        for (std::size_t k = 1; k < grid_.columns; ++k) {
          all.push_back(between(from, to, static_cast<double>(k) / static_cast<double>(grid_.columns)));
        }
      }
    }
    all.push_back({0, 0});
    return all;
  }

 private:
  std::uint32_t index(std::size_t body, std::size_t ring, std::size_t column) const {
    return static_cast<std::uint32_t>(grid_.size() + (body * grid_.rings + ring) * (grid_.columns - 1) + column - 1);
  }
  /// A point of a body: ring 0 joins the floors of its two flutes, and the last ring is the land.
  std::uint32_t at(std::size_t body, std::size_t ring, std::size_t column) const {
    if (ring == grid_.rings) return static_cast<std::uint32_t>(grid_.land(body, column));
    if (column == 0) return static_cast<std::uint32_t>(grid_.high(body, ring));
    if (column == grid_.columns) return static_cast<std::uint32_t>(grid_.lowOfNext(body, ring));
    return index(body, ring, column);
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles_.push_back({a, b, c}); }

  OutlineGrid grid_;
  std::uint32_t centre_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint16_t> tooth_;  ///< tooth of each body
};

/// Joins layers into a solid, less what a cut removes.
class Joiner {
 public:
  /// @param turns_on whether the outlines turn toward higher indices from layer to layer.
  Joiner(const OutlineGrid& grid, CutDirection direction, bool turns_on, const SolidCut& cut)
      : grid_(grid), direction_(direction), turns_on_(turns_on), mesh_(grid, direction), cut_(cut) {}

  /// @param with_inside whether the points inside are needed.
  void add(const SolidLayer& layer, bool with_inside) {
    sides_.erase(sides_.begin(), sides_.begin() + static_cast<std::ptrdiff_t>((end_ - begin_) * cut_.volumes()));
    begin_ = end_;
    end_ = static_cast<std::uint32_t>(solid_.vertices.size());
    for (const PolarPoint& p : with_inside ? mesh_.points(layer.outline) : layer.outline) {
      const double angle = units::kTurn * (p.turns - std::floor(p.turns));
      solid_.vertices.emplace_back(layer.x, p.radius * std::cos(angle), p.radius * std::sin(angle));
      sides_.resize(sides_.size() + cut_.volumes());
      cut_.findSides(solid_.vertices.back(), sides_.data() + sides_.size() - cut_.volumes());
    }
  }

  /// Joins the two layers added last.
  /// @param is_step whether they are at the same X.
  /// @param with_inside whether volumes are removed between them.
  void joinLayers(bool is_step, bool with_inside) {
    const auto n = static_cast<std::uint32_t>(grid_.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t next = (i + 1) % n;
      const SurfaceKind kind = is_step ? SurfaceKind::kEndFace : grid_.kind(i, direction_);
      const auto tooth = static_cast<std::uint16_t>(grid_.tooth(i, direction_));
      // The diagonal runs against the turn, as in the tetrahedra: the other diagonal would roughen a land.
      const bool up = (i < next) != turns_on_;
      const std::uint32_t from = up ? i : next, to = up ? next : i;
      addTriangle({begin_ + i, begin_ + next, end_ + to}, kind, tooth);
      addTriangle({begin_ + from, end_ + next, end_ + i}, kind, tooth);
    }
    if (!with_inside) return;
    for (const Triangle& t : mesh_.triangles()) addPrism(t);
  }

  /// Closes the solid at the layer added last.
  void close(bool toward_shank) {
    for (std::size_t i = 0; i < mesh_.triangles().size(); ++i) {
      auto [a, b, c] = mesh_.triangles()[i];
      if (!toward_shank) std::swap(b, c);
      addTriangle({end_ + a, end_ + b, end_ + c}, SurfaceKind::kEndFace, mesh_.toothOf(i));
    }
  }

  CutterSolid take() {
    if (cut_.isEmpty()) return std::move(solid_);
    const auto first = static_cast<std::uint32_t>(solid_.vertices.size());
    for (SolidTriangle& t : cut_part_.triangles) {
      for (std::uint32_t& v : t.vertices) v += first;
    }
    const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
    append(solid_.vertices, cut_part_.vertices);
    append(solid_.triangles, cut_part_.triangles);
    closeSeams(solid_);
    return std::move(solid_);
  }

 private:
  /// Cuts the prism between a triangle of the last layer but one and the same triangle of the last layer. The diagonals
  /// of its sides all run from the lower index to the higher, or all the other way, so that they match the neighbours'
  /// diagonals.
  void addPrism(Triangle t) {
    const bool odd = isOdd(t) != turns_on_;
    std::sort(t.begin(), t.end());
    if (turns_on_) std::reverse(t.begin(), t.end());
    const auto [a, b, c] = t;
    const auto touched = cut_.touched({sidesOf(begin_ + a), sidesOf(begin_ + b), sidesOf(begin_ + c), sidesOf(end_ + a),
                                       sidesOf(end_ + b), sidesOf(end_ + c)});
    if (!touched || touched->empty()) return;
    std::vector<CutFace> faces;
    const auto cut = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t l) {
      if (odd) std::swap(i, j);
      cut_.addFaces(*touched, {solid_.vertices[i], solid_.vertices[j], solid_.vertices[k], solid_.vertices[l]}, faces);
    };
    cut(begin_ + a, begin_ + b, begin_ + c, end_ + c);
    cut(begin_ + a, begin_ + b, end_ + c, end_ + b);
    cut(begin_ + a, end_ + a, end_ + b, end_ + c);
    for (const CutFace& face : faces) append(face.polygon, face.kind, face.tooth);
  }

  /// Whether sorting the corners turns the triangle over.
  static bool isOdd(const Triangle& t) { return (t[0] > t[1]) ^ (t[1] > t[2]) ^ (t[0] > t[2]); }

  static bool hasArea(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return !(a == b || b == c || c == a);
  }

  /// Of a vertex of the two layers added last.
  const std::uint64_t* sidesOf(std::uint32_t vertex) const {
    return sides_.data() + (vertex - begin_) * cut_.volumes();
  }

  void append(const Polygon& polygon, SurfaceKind kind, std::uint16_t tooth) {
    const auto first = static_cast<std::uint32_t>(cut_part_.vertices.size());
    cut_part_.vertices.insert(cut_part_.vertices.end(), polygon.begin(), polygon.end());
    for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i) {
      if (!hasArea(polygon[0], polygon[i], polygon[i + 1])) continue;
      cut_part_.triangles.push_back({{first, first + i, first + i + 1}, kind, tooth});
    }
  }

  void addTriangle(const Triangle& v, SurfaceKind kind, std::uint16_t tooth) {
    if (!hasArea(solid_.vertices[v[0]], solid_.vertices[v[1]], solid_.vertices[v[2]])) return;
    const auto touched = cut_.touched({sidesOf(v[0]), sidesOf(v[1]), sidesOf(v[2])});
    if (!touched) return;
    if (touched->empty()) return solid_.triangles.push_back({v, kind, tooth});
    for (const Polygon& p :
         cut_.outside(*touched, {solid_.vertices[v[0]], solid_.vertices[v[1]], solid_.vertices[v[2]]}))
      append(p, kind, tooth);
  }

  OutlineGrid grid_;
  CutDirection direction_;
  bool turns_on_;
  SectionMesh mesh_;
  const SolidCut& cut_;
  CutterSolid solid_;                  ///< of the points of the layers
  CutterSolid cut_part_;               ///< the pieces of what is cut
  std::vector<std::uint64_t> sides_;   ///< SolidCut::findSides() of the two layers added last
  std::uint32_t begin_ = 0, end_ = 0;  ///< first points of the two layers added last
};

/// The box about a solid.
Box boxOf(const std::vector<SolidLayer>& layers) {
  double radius = 0;
  for (const SolidLayer& layer : layers) {
    for (const PolarPoint& p : layer.outline) radius = std::max(radius, p.radius);
  }
  return {{layers.front().x, -radius, -radius}, {layers.back().x, radius, radius}};
}

void check(const SolidExtent& extent, const SolidResolution& resolution) {
  require(std::isfinite(extent.from), "solid: from", extent.from, "a finite X [m]");
  require(extent.to > extent.from && std::isfinite(extent.to), "solid: to", extent.to, "beyond `from`, finite [m]");
  require(std::isfinite(extent.shank_to), "solid: shank_to", extent.shank_to, "a finite X [m]");
  require(!(extent.shank_to > extent.to) || (extent.shank_diameter > 0 && std::isfinite(extent.shank_diameter)),
          "solid: shank_diameter", extent.shank_diameter, "positive and finite [m]");
  require(resolution.sections >= 2, "solid: sections", static_cast<double>(resolution.sections), "from 2");
  require(resolution.around >= 3, "solid: around", static_cast<double>(resolution.around), "from 3");
}

}  // namespace

double CutterSolid::volume() const {
  double six = 0;
  for (const SolidTriangle& t : triangles) {
    six += vertices[t.vertices[0]].dot(vertices[t.vertices[1]].cross(vertices[t.vertices[2]]));
  }
  return six / 6;
}

CutterSolid cutterSolid(const GroundCutter& cutter, const SolidExtent& extent, const SolidResolution& resolution,
                        const std::vector<RemovedVolume>& removed) {
  check(extent, resolution);
  const OutlineGrid grid = gridOf(cutter, resolution);
  const std::vector<SolidLayer> layers = solidLayers(cutter, extent, resolution, grid);
  const bool turns_on = layers.front().outline.front().turns < layers.back().outline.front().turns;
  const SolidCut cut(removed, boxOf(layers));
  Joiner joiner(grid, cutter.direction(), turns_on, cut);
  joiner.add(layers.front(), true);
  joiner.close(false);
  for (std::size_t i = 1; i < layers.size(); ++i) {
    const bool is_cut = layers[i - 1].x <= cut.reach();
    joiner.add(layers[i], is_cut || i + 1 == layers.size());
    joiner.joinLayers(layers[i].x == layers[i - 1].x, is_cut);
  }
  joiner.close(true);
  return joiner.take();
}

}  // namespace grinder
