#include "flute_grinder/tool/cutter_solid.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/require.h"
#include "flute_grinder/base/units.h"
#include "tool/seams.h"
#include "tool/solid_cut.h"
#include "tool/solid_layers.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
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

/// The corners of a solid, and what joins them.
struct Frame {
  Frame(const OutlineGrid& grid, CutDirection direction, const std::vector<SolidLayer>& layers, const SolidCut& cut)
      : grid(grid),
        direction(direction),
        turns_on(layers.front().outline.front().turns < layers.back().outline.front().turns),
        mesh(grid, direction),
        cut(cut) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const double x = layers[i].x;
      is_step.push_back(i > 0 && x == layers[i - 1].x);
      is_cut.push_back(layers[i > 0 ? i - 1 : 0].x <= cut.reach());
      begin.push_back(static_cast<std::uint32_t>(vertices.size()));
      const bool with_inside = is_cut.back() || i == 0 || i + 1 == layers.size();
      for (const PolarPoint& p : with_inside ? mesh.points(layers[i].outline) : layers[i].outline) {
        const double angle = units::kTurn * (p.turns - std::floor(p.turns));
        vertices.emplace_back(x, p.radius * std::cos(angle), p.radius * std::sin(angle));
      }
    }
    begin.push_back(static_cast<std::uint32_t>(vertices.size()));
  }

  OutlineGrid grid;
  CutDirection direction;
  bool turns_on;  ///< whether the outlines turn toward higher indices from layer to layer
  SectionMesh mesh;
  const SolidCut& cut;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::uint32_t> begin;  ///< first vertex of each layer, and the end of all
  std::vector<bool> is_step;         ///< whether a layer is at the X of the one before
  std::vector<bool> is_cut;          ///< whether the cut reaches from the layer before to this one
};

/// The part of a solid between two layers, or at one end, less what a cut removes.
class Piece {
 public:
  /// @param first,last layers: that of an end, or one and the next.
  Piece(const Frame& frame, std::size_t first, std::size_t last)
      : frame_(frame), is_cut_(frame.is_cut[last]), begin_(frame.begin[first]), end_(frame.begin[last]) {
    if (is_cut_) findSides(frame.begin[last + 1]);
    if (first == last) {
      close(first > 0);
    } else {
      join(frame.is_step[last]);
    }
    sides_ = {};  // there are as many pieces as layers
  }

  /// How many addTo() adds.
  std::size_t vertexCount() const { return cut_part_.vertices.size(); }
  std::size_t triangleCount() const { return triangles_.size() + cut_part_.triangles.size(); }

  /// Adds it to a solid that begins with the frame's vertices.
  void addTo(CutterSolid& solid) const {
    const auto first = static_cast<std::uint32_t>(solid.vertices.size());
    solid.vertices.insert(solid.vertices.end(), cut_part_.vertices.begin(), cut_part_.vertices.end());
    solid.triangles.insert(solid.triangles.end(), triangles_.begin(), triangles_.end());
    for (SolidTriangle t : cut_part_.triangles) {
      for (std::uint32_t& v : t.vertices) v += first;
      solid.triangles.push_back(t);
    }
  }

 private:
  void findSides(std::uint32_t end) {
    const std::vector<Eigen::Vector3d>& at = frame_.vertices;
    near_ = frame_.cut.between(at[begin_].x(), at[end_].x());
    sides_.resize((end - begin_) * near_.size());
    for (std::uint32_t v = begin_; v < end; ++v) {
      frame_.cut.findSides(near_, at[v], sides_.data() + (v - begin_) * near_.size());
    }
  }

  void join(bool is_step) {
    const OutlineGrid& grid = frame_.grid;
    const auto n = static_cast<std::uint32_t>(grid.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t next = (i + 1) % n;
      const SurfaceKind kind = is_step ? SurfaceKind::kEndFace : grid.kind(i, frame_.direction);
      const auto tooth = static_cast<std::uint16_t>(grid.tooth(i, frame_.direction));
      // The diagonal runs against the turn, as in the tetrahedra: the other diagonal would roughen a land.
      const bool up = (i < next) != frame_.turns_on;
      const std::uint32_t from = up ? i : next, to = up ? next : i;
      addTriangle({begin_ + i, begin_ + next, end_ + to}, kind, tooth);
      addTriangle({begin_ + from, end_ + next, end_ + i}, kind, tooth);
    }
    if (!is_cut_) return;
    for (const Triangle& t : frame_.mesh.triangles()) addPrism(t);
  }

  void close(bool toward_shank) {
    const SectionMesh& mesh = frame_.mesh;
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
      auto [a, b, c] = mesh.triangles()[i];
      if (!toward_shank) std::swap(b, c);
      addTriangle({end_ + a, end_ + b, end_ + c}, SurfaceKind::kEndFace, mesh.toothOf(i));
    }
  }

  /// Cuts the prism between a triangle of one layer and the same triangle of the next. The diagonals of its sides all
  /// run from the lower index to the higher, or all the other way, so that they match the neighbours' diagonals.
  void addPrism(Triangle t) {
    const bool odd = isOdd(t) != frame_.turns_on;
    std::sort(t.begin(), t.end());
    if (frame_.turns_on) std::reverse(t.begin(), t.end());
    const auto [a, b, c] = t;
    const auto touched = SolidCut::touched(near_, {sidesOf(begin_ + a), sidesOf(begin_ + b), sidesOf(begin_ + c),
                                                   sidesOf(end_ + a), sidesOf(end_ + b), sidesOf(end_ + c)});
    if (!touched || touched->empty()) return;
    std::vector<CutFace> faces;
    const auto cut = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t l) {
      if (odd) std::swap(i, j);
      const auto& at = frame_.vertices;
      frame_.cut.addFaces(*touched, {at[i], at[j], at[k], at[l]}, faces);
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

  const std::uint64_t* sidesOf(std::uint32_t vertex) const { return sides_.data() + (vertex - begin_) * near_.size(); }

  void append(const Polygon& polygon, SurfaceKind kind, std::uint16_t tooth) {
    const auto first = static_cast<std::uint32_t>(cut_part_.vertices.size());
    cut_part_.vertices.insert(cut_part_.vertices.end(), polygon.begin(), polygon.end());
    for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i) {
      if (!hasArea(polygon[0], polygon[i], polygon[i + 1])) continue;
      cut_part_.triangles.push_back({{first, first + i, first + i + 1}, kind, tooth});
    }
  }

  void addTriangle(const Triangle& v, SurfaceKind kind, std::uint16_t tooth) {
    const Eigen::Vector3d &a = frame_.vertices[v[0]], &b = frame_.vertices[v[1]], &c = frame_.vertices[v[2]];
    if (!hasArea(a, b, c)) return;
    if (!is_cut_) return triangles_.push_back({v, kind, tooth});
    const auto touched = SolidCut::touched(near_, {sidesOf(v[0]), sidesOf(v[1]), sidesOf(v[2])});
    if (!touched) return;
    if (touched->empty()) return triangles_.push_back({v, kind, tooth});
    for (const Polygon& p : frame_.cut.outside(*touched, {a, b, c})) append(p, kind, tooth);
  }

  const Frame& frame_;
  bool is_cut_;
  std::uint32_t begin_, end_;             ///< first vertices of the two layers; of an end both the same
  SolidCut::Volumes near_;                ///< of the cut
  std::vector<std::uint64_t> sides_;      ///< on which sides of those the points of both layers are
  std::vector<SolidTriangle> triangles_;  ///< those of the frame's vertices
  CutterSolid cut_part_;                  ///< the pieces of what is cut
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
  const SolidCut cut(removed, boxOf(layers));
  Frame frame(grid, cutter.direction(), layers, cut);
  const std::size_t last = layers.size() - 1;
  std::vector<std::optional<Piece>> pieces(last + 2);  // one end, what is between two layers, the other end
  onAllCores(pieces.size(), [&](std::size_t i) { pieces[i].emplace(frame, i > 0 ? i - 1 : 0, std::min(i, last)); });
  CutterSolid solid;
  std::size_t vertices = frame.vertices.size(), triangles = 0;
  for (const auto& piece : pieces) {
    vertices += piece->vertexCount();
    triangles += piece->triangleCount();
  }
  solid.vertices = std::move(frame.vertices);
  solid.vertices.reserve(vertices);
  solid.triangles.reserve(triangles);
  for (const auto& piece : pieces) piece->addTo(solid);
  if (!cut.isEmpty()) closeSeams(solid);
  return solid;
}

}  // namespace grinder
