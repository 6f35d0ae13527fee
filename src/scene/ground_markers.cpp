#include "flute_grinder/scene/ground_markers.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/cutter_solid.h"
#include "flute_grinder/tool/end_volumes.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/ground_tool.h"
#include "scene/shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kEnd = 0.066;             ///< X of the shank's end within the collet [m]
constexpr double kMaxTriangles = 9000;     ///< maximum number of triangles, of 120 bytes each, before the cut adds some
constexpr double kMaxWithEnd = 7500;       ///< the same where the end adds some, too
constexpr double kLabelHeight = 0.03;      ///< height of letters, as a fraction of the flute's length
constexpr double kOverlap = 0.02;          ///< of the shank and the ground part, as a fraction of the radius
constexpr std::size_t kPlaces = 13;        ///< places over the flute's length where rake and clearance are measured
constexpr std::size_t kErrorColours = 16;  ///< number of colours within the tolerance
constexpr std::size_t kPointsPerMarker = kMaxMarkerPoints / 3 * 3;
/// The cut seen by the camera of rviz/grinder.rviz at A = 0: the section along the axis, above what remains of the
/// flutes.
constexpr double kCutFrom = 35 * units::kDegree, kCutTo = 120 * units::kDegree;

/// The strokes of each tooth: the deepest finished one, if any, and the running one.
std::vector<std::vector<GrindStroke>> strokesSoFar(const ValidJob& job, const Reached& reached) {
  std::vector<double> deepest(job->tooth_angles.size(), 0);
  std::vector<std::vector<GrindStroke>> strokes(job->tooth_angles.size());
  const auto at = [&](std::size_t tooth, double depth) {
    return strokeOf(job, static_cast<int>(tooth), depth, job->process().wheel_wear);
  };
  for (const JobPass& pass : job.passes()) {
    const auto tooth = static_cast<std::size_t>(pass.place.tooth);
    const bool runs = pass.place == reached.pass;
    if (runs && reached.phase == PassPhase::kBefore) break;
    if (runs && reached.phase == PassPhase::kStroke) {
      GrindStroke stroke = at(tooth, pass.depth);
      stroke.to = std::clamp(reached.x, std::min(stroke.from, stroke.to), std::max(stroke.from, stroke.to));
      strokes[tooth].push_back(stroke);
      break;
    }
    deepest[tooth] = std::max(deepest[tooth], pass.depth);
    if (runs) break;
  }
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (deepest[i] > 0) strokes[i].push_back(at(i, deepest[i]));
    // A stroke in the air removes nothing.
    if (strokes[i].empty()) strokes[i].push_back(at(i, -job->process().clearance));
  }
  return strokes;
}

/// What is taken from the end so far; the running stroke counts once it has ended.
EndVolumes endSoFar(const ValidJob& job, const std::optional<Reached>& reached) {
  if (!job.isStraight() || !reached) return endVolumesOf(job);
  std::map<int, double> deepest;
  for (const JobPass& pass : job.passes()) {
    const bool runs = pass.place == reached->pass;
    if (runs && reached->phase != PassPhase::kAfter) break;
    deepest[pass.place.tooth] = std::max(deepest[pass.place.tooth], pass.depth);
    if (runs) break;
  }
  const std::vector<double> wear = job.wearOfTeeth();
  EndStrokes strokes;
  for (const auto& [tooth, depth] : deepest) {
    strokes.emplace(tooth, job.faceStroke(tooth, depth, wear[static_cast<std::size_t>(tooth)]));
  }
  return endVolumesOf(job, strokes);
}

bool isSame(const std::vector<GrindStroke>& a, const std::vector<GrindStroke>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const GrindStroke& s, const GrindStroke& t) { return s.to == t.to && s.y == t.y; });
}

/// X of the shank's start; nothing if it is unknown: then the flutes run out into the shank.
std::optional<double> shankOf(const CutterGeometry& cutter) {
  if (!(cutter.neck_length > 0)) return std::nullopt;
  return cutter.flute_length + cutter.neck_length;
}

/// The part of the cutter that the wheel may touch. The rest is round.
SolidExtent extentOf(const ValidJob& job) {
  const double stroke_end = job->cutter.flute_length + job->operations.front().overtravel_shank;
  const double end = groundTo(*job);
  const auto shank = shankOf(job->cutter);
  if (!shank) return {0, stroke_end, job->cutter.shank_diameter, end};
  return {0, std::min(*shank, end), job->cutter.shank_diameter, 0};
}

/// The finest resolution with this number of triangles.
SolidResolution resolutionOf(const ValidJob& job, double max_triangles) {
  const SolidExtent extent = extentOf(job);
  double turns = 0;
  for (std::size_t i = 0; i < job->tooth_angles.size(); ++i) {
    const LogCurve curve{ConicalCutter(job.cutterOf(static_cast<int>(i)))};
    turns = std::max(turns, std::abs(curve.a(extent.to)) / (2 * units::kPi));
  }
  const auto teeth = static_cast<double>(job->tooth_angles.size());
  // Rings resolve the flutes; facets around the axis show on lands, neck and shank, which are round.
  SolidResolution r{40, 16, 120};
  const auto triangles = [&] {
    const auto rings = static_cast<double>(r.rings), around = std::max(teeth, static_cast<double>(r.around));
    const auto sections = static_cast<double>(r.sections);
    const double shank = std::max(0.0, extent.shank_to - extent.to);
    const double layers = std::max(sections, turns * around) + sections * shank / extent.to;
    return 2 * layers * (2 * rings * teeth + around) + 4 * rings * around;
  };
  while (triangles() > max_triangles && r.rings > 8) --r.rings;
  while (triangles() > max_triangles && r.around > 48) --r.around;
  while (triangles() > max_triangles && r.rings > 6) --r.rings;
  while (triangles() > max_triangles && r.around > 24) --r.around;
  while (triangles() > max_triangles && r.rings > 4) --r.rings;
  while (triangles() > max_triangles && r.around > 6) --r.around;
  while (triangles() > max_triangles && r.sections > 12) --r.sections;
  return r;
}

/// The places where the last pass of a tooth has been; before it, an angle is not the tool's.
class LastPasses {
 public:
  /// @param reached nothing for a finished job.
  LastPasses(const ValidJob& job, const std::optional<Reached>& reached)
      : from_end_(job->process().direction == StrokeDirection::kFromEnd) {
    const int last = static_cast<int>(job.depths().size()) - 1;
    teeth_.resize(job->tooth_angles.size());
    for (const auto& [pass, depth, wear] : job.passes()) {
      const bool runs = reached && pass == reached->pass;
      if (runs && reached->phase != PassPhase::kStroke && reached->phase != PassPhase::kAfter) break;
      const bool all = !runs || reached->phase == PassPhase::kAfter;
      if (pass.pass == last) teeth_[static_cast<std::size_t>(pass.tooth)] = {true, all, all ? 0 : reached->x};
      if (runs) break;
    }
  }

  bool at(double x, std::size_t tooth) const {
    const Reach& reach = teeth_[tooth];
    return reach.begun && (reach.whole || (from_end_ ? x <= reach.x : x >= reach.x));
  }

 private:
  struct Reach {
    bool begun = false;
    bool whole = false;
    double x = 0;  ///< X that the stroke has reached [m]
  };

  bool from_end_;
  std::vector<Reach> teeth_;
};

/// The differences of rake faces and primary reliefs from the asked rake and clearance, as a fraction of the tolerance.
class Deviations {
 public:
  /// @param reached nothing for a finished job.
  Deviations(const GroundCutter& cutter, const ValidJob& job, const std::optional<Reached>& reached)
      : length_(job->cutter.flute_length), kind_(job->process().kind), last_(job, reached) {
    const CutterGeometry& asked = job->cutter;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      std::vector<Parts>& of_teeth = parts_.emplace_back();
      for (const ToothSection& tooth : cutter.section(length_ * static_cast<double>(i) / (kPlaces - 1)).teeth) {
        Parts& parts = of_teeth.emplace_back();
        if (tooth.rake && tooth.complete) parts.rake = std::abs(*tooth.rake - asked.rake_angle) / asked.rake_tolerance;
        if (!tooth.relief || !tooth.relief->clearance) continue;
        parts.clearance = std::abs(*tooth.relief->clearance - asked.clearance) / asked.clearance_tolerance;
      }
    }
  }

  /// The difference at the nearest measured place; nothing where the surface is not finished.
  std::optional<double> at(SurfaceKind surface, double x, std::size_t tooth) const {
    const bool rake = surface == SurfaceKind::kRakeFace;
    if ((!rake && surface != SurfaceKind::kPrimary) || x > length_) return std::nullopt;
    // A surface of a preceding operation is finished.
    const bool own = kind_ == (rake ? OperationKind::kFlute : OperationKind::kPrimaryRelief);
    if (own && !last_.at(x, tooth)) return std::nullopt;
    const double place = std::clamp(x / length_, 0.0, 1.0) * (kPlaces - 1);
    const Parts& parts = parts_[static_cast<std::size_t>(std::lround(place))][tooth];
    return rake ? parts.rake : parts.clearance;
  }

 private:
  struct Parts {
    std::optional<double> rake;  ///< rake difference; nothing where the flute is not complete
    std::optional<double> clearance;
  };

  double length_;
  OperationKind kind_;
  LastPasses last_;
  std::vector<std::vector<Parts>> parts_;  ///< deviations by place, then tooth
};

std_msgs::ColorRGBA colourOf(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kRakeFace: return colour(0.55, 0.57, 0.62);
    case SurfaceKind::kFluteBack: return colour(0.45, 0.50, 0.60);
    case SurfaceKind::kGash: return colour(0.50, 0.60, 0.55);
    case SurfaceKind::kEndPrimary:
    case SurfaceKind::kEndSecondary: return colour(0.66, 0.70, 0.76);
    case SurfaceKind::kChamfer: return colour(0.80, 0.74, 0.62);
    case SurfaceKind::kLand:
    case SurfaceKind::kPrimary:
    case SurfaceKind::kEndFace:
    case SurfaceKind::kShank: return colour(0.74, 0.75, 0.77);
    case SurfaceKind::kCut: break;
  }
  return colour(0.93, 0.89, 0.70);  // different from the wheel's colour
}

void appendShadedSolid(MarkerArray& array, const char* ns, const std::vector<OutlinePoint>& outline,
                       const std_msgs::ColorRGBA& colour) {
  Marker& m = appendSolid(array, ns, "cutter", outline, colour);
  std::vector<Eigen::Vector3d> corners;
  for (const geometry_msgs::Point& p : m.points) corners.emplace_back(p.x, p.y, p.z);
  for (const Eigen::Vector3d& normal : smoothNormals(corners)) m.colors.push_back(lit(colour, normal));
}

/// The neck, if there is one, and the shank, as far as they lie beyond extentOf().
void appendShank(MarkerArray& array, const ValidJob& job, const char* ns) {
  const ConicalCutter cutter(job->cutter);
  const SolidExtent extent = extentOf(job);
  const auto neck_end = shankOf(job->cutter);
  const double from = neck_end ? extent.to : extent.shank_to, shank = neck_end.value_or(from);
  const double end = std::max(kEnd, shank), radius = job->cutter.shank_diameter / 2;
  // It begins a little inside the ground part, whose facets are not its own, and has no face there: either would show
  // as a line of dots.
  const double before = from - kOverlap * radius;
  std::vector<OutlinePoint> outline;
  if (neck_end) outline = {{before, cutter.radius(before)}, {shank, cutter.radius(shank)}, {shank, radius}};
  if (!neck_end) outline = {{before, radius}};
  outline.insert(outline.end(), {{end, radius}, {end, 0}});
  appendShadedSolid(array, ns, outline, colourOf(SurfaceKind::kShank));
}

/// Which of the error's colours stands for a deviation, as a fraction of the tolerance; the last beyond it.
std::size_t levelOf(double deviation) {
  if (!(deviation <= 1)) return kErrorColours;
  return std::min(static_cast<std::size_t>(deviation * kErrorColours), kErrorColours - 1);
}

std_msgs::ColorRGBA colourOfLevel(std::size_t level) {
  return errorColour((static_cast<double>(level) + 0.5) / kErrorColours);
}

constexpr std::size_t kColours = 1 + kErrorColours + 1;  ///< number of colours of a kind of surface

/// The blank before the first stroke.
void appendBlank(MarkerArray& array, const ValidJob& job, const char* ns) {
  const ConicalCutter cutter(job->cutter);
  const double shank = shankOf(job->cutter).value_or(extentOf(job).to), end = std::max(kEnd, shank);
  const double radius = job->cutter.shank_diameter / 2;
  appendShadedSolid(
      array, ns,
      {{0, 0}, {0, cutter.radius(0)}, {shank, cutter.radius(shank)}, {shank, radius}, {end, radius}, {end, 0}},
      colourOf(SurfaceKind::kShank));
}

/// One of the parts of the cutter that rviz shows or hides.
struct Part {
  const char* ns;
  CutterSolid solid;
};

/// The cutter without a wedge, and the wedge, both with the faces of the cut.
std::vector<Part> partsOf(const GroundCutter& cutter, const ValidJob& job, const char* ns,
                          const std::optional<Reached>& reached) {
  const EndVolumes end = endSoFar(job, reached);
  const SolidResolution resolution = resolutionOf(job, end.removed.empty() ? kMaxTriangles : kMaxWithEnd);
  SolidExtent extent = extentOf(job);
  extent.from = end.blank_x;
  const RemovedVolume cut_out = wedge(kCutFrom, kCutTo);
  std::vector<RemovedVolume> removed = end.removed;
  removed.push_back(cut_out);
  Part rest{ns, cutterSolid(cutter, extent, resolution, removed)};
  removed.pop_back();
  for (const Plane& plane : cut_out.body) removed.push_back({{{-plane.normal, -plane.offset}}, {}});
  Part inside{kCutOut, cutterSolid(cutter, extent, resolution, removed)};
  for (CutterSolid* solid : {&rest.solid, &inside.solid}) {
    // Toward the shank: through the cracks one would see dots of it.
    const double last = std::max(extent.to, extent.shank_to);
    const auto is_last = [&](const SolidTriangle& face) {
      return std::all_of(face.vertices.begin(), face.vertices.end(),
                         [&](std::uint32_t v) { return solid->vertices[v].x() == last; });
    };
    auto& faces = solid->triangles;
    faces.erase(std::remove_if(faces.begin(), faces.end(), is_last), faces.end());
  }
  return {std::move(rest), std::move(inside)};
}

/// Corners of triangles in one colour.
struct Corners {
  std::vector<geometry_msgs::Point> at;
  std::vector<Eigen::Vector3d> normals;  ///< of each corner, or none, for rviz to light it facet by facet
};

void appendTriangles(MarkerArray& array, const char* ns, const Corners& corners, const std_msgs::ColorRGBA& colour) {
  for (std::size_t first = 0; first < corners.at.size(); first += kPointsPerMarker) {
    Marker& m = append(array, ns, Marker::TRIANGLE_LIST, "cutter");
    m.color = colour;
    for (std::size_t i = first; i < std::min(first + kPointsPerMarker, corners.at.size()); ++i) {
      m.points.push_back(corners.at[i]);
      if (!corners.normals.empty()) m.colors.push_back(lit(colour, corners.normals[i]));
    }
  }
}

/// Appends the faces of the cut, which are plane: rviz lights them well.
void appendCut(MarkerArray& array, const Part& part) {
  Corners corners;
  for (const SolidTriangle& t : part.solid.triangles) {
    if (t.kind != SurfaceKind::kCut) continue;
    for (const std::uint32_t v : t.vertices) {
      const Eigen::Vector3d& at = part.solid.vertices[v];
      corners.at.push_back(point(at.x(), at.y(), at.z()));
    }
  }
  appendTriangles(array, part.ns, corners, colourOf(SurfaceKind::kCut));
}

/// Appends the surfaces of one kind of all parts, whose normals go on from part to part.
void appendSurfaces(MarkerArray& array, const std::vector<Part>& parts, SurfaceKind kind,
                    const Deviations& deviations) {
  std::vector<Eigen::Vector3d> corners;
  for (const Part& part : parts) {
    for (const SolidTriangle& t : part.solid.triangles) {
      if (t.kind != kind) continue;
      for (const std::uint32_t v : t.vertices) corners.push_back(part.solid.vertices[v]);
    }
  }
  const std::vector<Eigen::Vector3d> normals = smoothNormals(corners);
  std::size_t next = 0;
  for (const Part& part : parts) {
    std::array<Corners, kColours> by_colour;
    for (const SolidTriangle& t : part.solid.triangles) {
      if (t.kind != kind) continue;
      const auto deviation = deviations.at(t.kind, corners[next].x(), t.tooth);
      Corners& same = by_colour[deviation ? 1 + levelOf(*deviation) : 0];
      for (const std::size_t end = next + 3; next < end; ++next) {
        same.at.push_back(point(corners[next].x(), corners[next].y(), corners[next].z()));
        same.normals.push_back(normals[next]);
      }
    }
    for (std::size_t i = 0; i < kColours; ++i) {
      appendTriangles(array, part.ns, by_colour[i], i == 0 ? colourOf(kind) : colourOfLevel(i - 1));
    }
  }
}

}  // namespace

void Reached::add(const Setpoint& setpoint, const Axes& actual, StrokeDirection direction) {
  const PassPhase now = phaseOf(setpoint.move);
  if (now == PassPhase::kNone) return;
  const ToothPass running{setpoint.tooth, setpoint.pass};
  if (now != PassPhase::kStroke) {
    *this = {running, now, 0};
    return;
  }
  if (phase != now) *this = {running, now, setpoint.position[kX]};
  // NaN from a faulty drive fails both comparisons.
  if (direction == StrokeDirection::kFromEnd ? actual[kX] > x : actual[kX] < x) x = actual[kX];
}

GroundCutter groundSoFar(const ValidJob& job, const Reached& reached) {
  if (job.isStraight()) return groundCutterOf(job);
  const std::vector<std::vector<GrindStroke>> strokes = strokesSoFar(job, reached);
  std::optional<GroundCutter> before;
  if (job.relief(0) != nullptr) before = groundBefore(job);
  std::vector<Flute> flutes;
  std::vector<GroundTooth> teeth;
  std::vector<Reliefs> reliefs;
  const auto spiral = [&](std::size_t k) { return job.cutterOf(static_cast<int>(k)).spiral_angle; };
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const auto is_same = [&](std::size_t k) {
      return (before ? before->teeth()[k].flute == before->teeth()[i].flute : spiral(k) == spiral(i)) &&
             isSame(strokes[k], strokes[i]);
    };
    std::size_t same = 0;
    while (same < i && !is_same(same)) ++same;
    teeth.push_back({job->tooth_angles[i], same < i ? teeth[same].flute : flutes.size()});
    if (same < i) continue;
    std::vector<WheelSweep> swept;
    for (const GrindStroke& stroke : strokes[i]) {
      swept.push_back(sweepOf(job, static_cast<int>(i), job->process().wheel_wear, stroke));
    }
    flutes.push_back(before ? before->flutes()[before->teeth()[i].flute] : swept);
    if (!before) continue;
    reliefs.push_back(before->reliefs(i));
    if (!swept.empty()) reliefs.back().push_back(std::move(swept));
  }
  return {ConicalCutter(job->cutter), std::move(flutes), std::move(teeth), std::move(reliefs),
          job->cutter.chordal_rake_depth};
}

MarkerArray groundMarkers(const GroundCutter& cutter, const ValidJob& job, const char* ns,
                          const std::optional<Reached>& reached) {
  MarkerArray array = clearedArray();
  try {
    const bool of_flutes = job->process().kind == OperationKind::kFlute;
    if (of_flutes && reached && reached->pass == job.passes().front().place && reached->phase == PassPhase::kBefore) {
      appendBlank(array, job, ns);
      return array;
    }
    const std::vector<Part> parts = partsOf(cutter, job, ns, reached);
    const Deviations deviations(cutter, job, reached);
    appendCut(array, parts.front());
    for (std::size_t kind = 0; kind < static_cast<std::size_t>(SurfaceKind::kCut); ++kind) {
      appendSurfaces(array, parts, static_cast<SurfaceKind>(kind), deviations);
    }
    appendShank(array, job, ns);
  } catch (const std::invalid_argument& error) {  // thrown before the first marker is appended
    Marker& label = append(array, "label", Marker::TEXT_VIEW_FACING, "cutter");
    label.pose.position = point(job->cutter.flute_length / 2, 0, 0);
    label.scale.z = kLabelHeight * job->cutter.flute_length;
    label.text = error.what();
  }
  return array;
}

}  // namespace grinder
