#include "flute_grinder/tool/ground_cutter.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/relief_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace grinder {

namespace {

constexpr int kRings = 64;             ///< rings for the area of a section
constexpr double kChordalDepth = 0.1;  ///< depth of the chord, as a fraction of the flute's depth
constexpr int kRingsOfDepth = 6;       ///< rings on which a flute must be complete
constexpr int kRingsOfLand = 8;        ///< rings on which a tooth must have material left
constexpr double kRangeAccuracy = 10e-6;
constexpr double kSameArcEnd = 1e-6;  ///< tolerance for equal ends of the arcs of several strokes [m]
constexpr double kSamePitch = 1e-9;   ///< [rad]

/// An angle reduced to one turn.
double withinTurn(double angle) { return angle - units::kTurn * std::floor(angle / units::kTurn); }

/// The angle that some arcs cover together.
double covered(const std::vector<Arc>& arcs) {
  std::vector<Arc> parts;
  for (const Arc& arc : arcs) {
    if (arc.high - arc.low >= units::kTurn) return units::kTurn;
    const double low = withinTurn(arc.low);
    const double high = low + (arc.high - arc.low);
    parts.push_back({low, std::min(high, units::kTurn)});
    if (high > units::kTurn) parts.push_back({0, high - units::kTurn});
  }
  std::sort(parts.begin(), parts.end(), [](const Arc& a, const Arc& b) { return a.low < b.low; });
  double sum = 0, end = 0;
  for (const Arc& part : parts) {
    sum += std::max(0.0, part.high - std::max(part.low, end));
    end = std::max(end, part.high);
  }
  return sum;
}

/// The area of a ring of a section, of which an angle counts on each circle [m^2].
/// @param radii radii of the ring [m].
/// @param angle_at called with a radius; returns the angle [rad].
template <typename Angle>
double areaOfRings(const Range& radii, const Angle& angle_at) {
  const double depth = radii.to - radii.from;
  double area = 0;
  for (int i = 0; i < kRings; ++i) {
    // Rings closer together toward the core, where the arcs open like a square root.
    const double u = (i + 0.5) / kRings;
    const double r = radii.from + depth * u * u;
    area += angle_at(r) * r * depth * 2 * u / kRings;
  }
  return area;
}

}  // namespace

double chordDepth(double asked, double flute_depth) noexcept { return asked > 0 ? asked : kChordalDepth * flute_depth; }

double chordAngle(double outer, double inner, double turn) noexcept {
  return std::atan2(inner * std::sin(turn), outer - inner * std::cos(turn));
}

double meanSpiral(const ConicalCutter& cutter, double from, double to, double turn) noexcept {
  const double diameter = cutter.cone().end_diameter;
  const LogCurve at_45_deg(2 * cutter.tanCone() / diameter, 2 / diameter);
  return std::atan(turn / (at_45_deg.a(to) - at_45_deg.a(from)));
}

std::optional<Wall> outermostWall(const std::vector<WheelSweep>& strokes, double x, double r, bool high) {
  std::optional<Wall> outermost;
  for (const WheelSweep& sweep : strokes) {
    const auto wall = sweep.wall(x, r, high);
    if (!wall) continue;
    if (!outermost || (high ? wall->angle > outermost->angle : wall->angle < outermost->angle)) outermost = wall;
  }
  return outermost;
}

double leastRadius(const std::vector<WheelSweep>& strokes, double x, double radius) {
  double min = radius;
  for (const WheelSweep& sweep : strokes) min = std::min(min, sweep.minRadius(x, radius));
  return min;
}

GroundCutter::GroundCutter(const ConicalCutter& cutter, std::vector<Flute> flutes, std::vector<GroundTooth> teeth,
                           std::vector<Reliefs> reliefs, double chordal_rake_depth)
    : cutter_(cutter),
      flutes_(std::move(flutes)),
      teeth_(std::move(teeth)),
      reliefs_(std::move(reliefs)),
      chordal_rake_depth_(chordal_rake_depth) {
  if (reliefs_.empty()) reliefs_.resize(flutes_.size());
  if (reliefs_.size() != flutes_.size()) {
    throw std::invalid_argument("reliefs of " + std::to_string(reliefs_.size()) + " flutes; allowed: none, or of " +
                                std::to_string(flutes_.size()));
  }
  for (const Flute& flute : flutes_) {
    if (flute.empty()) throw std::invalid_argument("a flute has 0 strokes; allowed: 1 or more");
  }
  for (const GroundTooth& tooth : teeth_) {
    if (tooth.flute < flutes_.size()) continue;
    throw std::invalid_argument("a tooth's flute = " + std::to_string(tooth.flute) + "; allowed: below " +
                                std::to_string(flutes_.size()));
  }
}

const Reliefs& GroundCutter::reliefs(std::size_t tooth) const { return reliefs_[teeth_[tooth].flute]; }

std::optional<Arc> GroundCutter::arc(const Flute& flute, double x, double r) const {
  std::optional<Arc> all;
  for (const WheelSweep& sweep : flute) {
    const auto one = sweep.arc(x, r);
    if (!one) continue;
    if (!all) all = one;
    if (one->low < all->low) all->low = one->low, all->low_x = one->low_x;
    if (one->high > all->high) all->high = one->high, all->high_x = one->high_x;
  }
  return all;
}

void GroundCutter::measureRake(const Flute& flute, double x, double r, const Wall& edge, ToothSection& section) const {
  const double hand = direction() == CutDirection::kRightHand ? 1 : -1;
  section.rake = std::atan(-hand * r * edge.slope);
  if (section.spiral) section.normal_rake = std::atan(std::tan(*section.rake) * std::cos(*section.spiral));
  const double inner = r - chordDepth(chordal_rake_depth_, section.depth);
  section.chordal_rake.reset();
  if (const auto face = rakeFace(flute, x, inner)) {
    section.chordal_rake = chordAngle(r, inner, hand * (face->angle - edge.angle));
  }
}

double GroundCutter::coreRadius(double x) const {
  double min = cutter_.radius(x);
  for (const Flute& flute : flutes_) min = std::min(min, coreRadius(flute, x));
  for (const Reliefs& reliefs : reliefs_) {
    for (const Relief& relief : reliefs) min = std::min(min, leastRadius(relief, x, cutter_.radius(x)));
  }
  return min;
}

std::vector<Arc> GroundCutter::arcsOn(double x, double r) const {
  std::vector<std::optional<Arc>> of_flutes;
  for (const Flute& flute : flutes_) of_flutes.push_back(arc(flute, x, r));
  std::vector<Arc> arcs;
  for (const GroundTooth& tooth : teeth_) {
    if (const auto& a = of_flutes[tooth.flute]) arcs.push_back({a->low + tooth.angle, a->high + tooth.angle});
    for (const Relief& relief : reliefs_[tooth.flute]) {
      for (const WheelSweep& sweep : relief) {
        if (const auto a = sweep.arc(x, r)) arcs.push_back({a->low + tooth.angle, a->high + tooth.angle});
      }
    }
  }
  return arcs;
}

double GroundCutter::areaRemoved(double x, double core_radius) const {
  return areaOfRings({core_radius, cutter_.radius(x)}, [&](double r) { return covered(arcsOn(x, r)); });
}

double GroundCutter::areaRemovedBy(const WheelSweep& stroke, double angle, double x) const {
  const double radius = cutter_.radius(x), core = stroke.minRadius(x, radius);
  if (!(core < radius)) return 0;
  return areaOfRings({core, radius}, [&](double r) {
    const auto own = stroke.arc(x, r);
    if (!own) return 0.0;
    std::vector<Arc> arcs = arcsOn(x, r);
    const double before = covered(arcs);
    arcs.push_back({own->low + angle, own->high + angle});
    return covered(arcs) - before;
  });
}

GroundCutter::NextTooth GroundCutter::next(std::size_t tooth) const {
  // Behind an edge that moves toward falling angles are larger angles.
  const std::size_t n = teeth_.size();
  const bool right = direction() == CutDirection::kRightHand;
  const std::size_t next = right ? (tooth + 1) % n : (tooth + n - 1) % n;
  const double turn = teeth_[next].angle - teeth_[tooth].angle, pitch = right ? turn : -turn;
  return {next, pitch > 0 ? pitch : pitch + units::kTurn};
}

void GroundCutter::measureLand(std::size_t tooth, const std::vector<ToothSection>& measured,
                               const std::vector<Arcs>& arcs, ToothSection& section) const {
  const NextTooth behind = next(tooth);
  const std::size_t own = teeth_[tooth].flute, other = teeth_[behind.tooth].flute;
  if (!measured[own].edge || !measured[other].edge) return;
  const bool right = direction() == CutDirection::kRightHand;
  const double turn = *measured[other].edge - *measured[own].edge;
  const double land = section.least_land = behind.pitch + (right ? turn : -turn) - *measured[other].flute;
  // Deep flutes may meet below the land, if there are many teeth.
  for (std::size_t i = 0; i < arcs[own].size(); ++i) {
    const auto &a = arcs[own][i], &b = arcs[other][i];
    if (!a || !b) continue;
    section.least_land = std::min(section.least_land, behind.pitch + (right ? b->low - a->high : a->low - b->high));
  }
  if (section.least_land > 0) section.land = land;
}

bool GroundCutter::landsAreAlike(std::size_t a, std::size_t b) const {
  const NextTooth behind_a = next(a), behind_b = next(b);
  return teeth_[a].flute == teeth_[b].flute && teeth_[behind_a.tooth].flute == teeth_[behind_b.tooth].flute &&
         std::abs(behind_a.pitch - behind_b.pitch) < kSamePitch;
}

bool GroundCutter::isComplete(const Flute& flute, double x, double core_radius) const {
  const double depth = cutter_.radius(x) - core_radius;
  for (int i = 1; i <= kRingsOfDepth; ++i) {
    if (!arcIsComplete(flute, x, core_radius + depth * i / kRingsOfDepth)) return false;
  }
  return true;
}

bool GroundCutter::arcIsComplete(const Flute& flute, double x, double r) const {
  std::vector<std::pair<const WheelSweep*, Arc>> reached;
  double min = std::numeric_limits<double>::infinity(), max = -min;
  for (const WheelSweep& sweep : flute) {
    const auto arc = sweep.arc(x, r);
    if (!arc) continue;
    reached.emplace_back(&sweep, *arc);
    min = std::min(min, arc->low);
    max = std::max(max, arc->high);
  }
  // An end is complete if the stroke that goes farthest there says so; of several equally far strokes, any.
  const auto complete = [&](double Arc::*angle, double Arc::*axis_x, double farthest, bool high) {
    return std::any_of(reached.begin(), reached.end(), [&](const auto& one) {
      const auto& [sweep, arc] = one;
      return std::abs(arc.*angle - farthest) * r <= kSameArcEnd &&
             sweep->isComplete(x, r, arc.*angle, arc.*axis_x, high);
    });
  };
  return complete(&Arc::low, &Arc::low_x, min, false) && complete(&Arc::high, &Arc::high_x, max, true);
}

ToothSection GroundCutter::tooth(std::size_t index, double x) const {
  const Flute& flute = flutes_[index];
  const double r = cutter_.radius(x);
  const bool right = direction() == CutDirection::kRightHand;
  ToothSection section;
  section.depth = r - coreRadius(flute, x);
  const auto face = rakeFace(flute, x, r), back = outermostWall(flute, x, r, !right);
  if (!face || !back) return section;
  section.edge = face->angle;
  section.edge_wheel_x = face->axis_x;
  section.flute = std::abs(face->angle - back->angle);
  section.spiral = std::atan(r * (face->turn + face->slope * cutter_.tanCone()));
  measureRake(flute, x, r, *face, section);
  return section;
}

GroundSection GroundCutter::section(double x) const {
  GroundSection section;
  section.x = x;
  section.radius = section.core_radius = cutter_.radius(x);
  std::vector<ToothSection> measured;
  for (std::size_t flute = 0; flute < flutes_.size(); ++flute) {
    ToothSection& one = measured.emplace_back(tooth(flute, x));
    const double core = section.radius - one.depth;
    one.complete = one.edge && isComplete(flutes_[flute], x, core);
    section.core_radius = std::min(section.core_radius, core);
  }
  std::vector<Arcs> arcs(flutes_.size());
  const double depth = section.radius - section.core_radius;
  for (std::size_t flute = 0; flute < flutes_.size(); ++flute) {
    for (int i = 1; i < kRingsOfLand; ++i)
      arcs[flute].push_back(arc(flutes_[flute], x, section.core_radius + depth * i / kRingsOfLand));
  }
  for (std::size_t i = 0; i < teeth_.size(); ++i) {
    section.teeth.push_back(measured[teeth_[i].flute]);
    ToothSection& tooth = section.teeth.back();
    if (tooth.edge) *tooth.edge += teeth_[i].angle;
    measureLand(i, measured, arcs, tooth);
  }
  const auto has_edge = [](const ToothSection& tooth) { return tooth.edge.has_value(); };
  if (!std::all_of(section.teeth.begin(), section.teeth.end(), has_edge)) return section;
  for (std::size_t i = 0; i < teeth_.size(); ++i) {
    if (reliefs(i).empty()) continue;
    std::size_t same = 0;
    while (same < i && !landsAreAlike(same, i)) ++same;
    ToothSection& tooth = section.teeth[i];
    tooth.relief = same < i ? section.teeth[same].relief : measureRelief(*this, section, i, reliefs(i));
    const double r = tooth.relief->edge_radius;
    const Flute& flute = flutes_[teeth_[i].flute];
    const auto edge = r < section.radius ? rakeFace(flute, x, r) : std::nullopt;
    if (edge) measureRake(flute, x, r, *edge, tooth);
    section.core_radius = std::min(section.core_radius, tooth.relief->core_radius);
  }
  return section;
}

bool GroundCutter::isComplete(double x) const {
  return std::all_of(flutes_.begin(), flutes_.end(),
                     [&](const Flute& flute) { return isComplete(flute, x, coreRadius(flute, x)); });
}

std::optional<Range> GroundCutter::completeRange(double from, double to) const {
  const double middle = (from + to) / 2;
  if (!isComplete(middle)) return std::nullopt;
  const auto last = [&](double out) {
    if (isComplete(out)) return out;
    double in = middle;
    while (std::abs(out - in) > kRangeAccuracy) {
      const double x = (in + out) / 2;
      (isComplete(x) ? in : out) = x;
    }
    return in;
  };
  return Range{last(from), last(to)};
}

double GroundCutter::volumeRemoved(double from, double to, int sections) const {
  std::vector<double> areas(static_cast<std::size_t>(sections));
  const double step = (to - from) / sections;
  onAllCores(areas.size(), [&](std::size_t i) {
    const double x = from + (static_cast<double>(i) + 0.5) * step;
    areas[i] = areaRemoved(x, coreRadius(x));
  });
  return std::accumulate(areas.begin(), areas.end(), 0.0) * step;
}

}  // namespace grinder
