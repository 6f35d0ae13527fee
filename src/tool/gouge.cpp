#include "flute_grinder/tool/gouge.h"

#include "flute_grinder/tool/ground_job.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace grinder {

namespace {

constexpr int kEvenSections = 6;   ///< equidistant sections, in addition to those where the axes were farthest off
constexpr int kCompared = 4;       ///< circles of a section on which the walls are compared
constexpr int kPlacesOfWall = 16;  ///< places of a wall from which the nearest one is refined
constexpr std::uintmax_t kNearestSteps = 60;

/// X of the sections in which a stroke is measured.
std::vector<double> sectionsOf(const RunStroke& stroke, const Range& blank) {
  const std::vector<PathDeviation>& all = stroke.deviations;
  const double length = stroke.range.to - stroke.range.from;
  std::vector<double> sections;
  const auto add = [&](double part) {
    sections.push_back(std::clamp(stroke.range.from + part * length, blank.from, blank.to));
  };
  for (int i = 0; i < kEvenSections; ++i) add(static_cast<double>(i) / (kEvenSections - 1));
  const auto add_farthest = [&](const auto& off) {
    const auto lower = [&](const PathDeviation& a, const PathDeviation& b) { return off(a) < off(b); };
    const auto farthest = std::minmax_element(all.begin(), all.end(), lower);
    const double parts = std::max(1.0, static_cast<double>(all.size() - 1));
    add(static_cast<double>(farthest.first - all.begin()) / parts);
    add(static_cast<double>(farthest.second - all.begin()) / parts);
  };
  add_farthest([](const PathDeviation& d) { return d.y; });
  add_farthest([](const PathDeviation& d) { return d.z; });
  add_farthest([](const PathDeviation& d) { return d.a; });
  std::sort(sections.begin(), sections.end());
  sections.erase(std::unique(sections.begin(), sections.end()), sections.end());
  return sections;
}

/// The flute that a job asks for, for a tooth at angle 0.
struct Asked {
  const WheelSweep& sweep;
  ConicalCutter cutter;

  /// The maximum depth of another sweep beyond the flute in a section, if greater than `min`; else at most `min` [m].
  double gouge(const WheelSweep& other, double x, double min) const {
    const double radius = cutter.radius(x);
    const double core = std::min(radius, sweep.minRadius(x, radius));
    const double floor = std::min(radius, other.minRadius(x, radius));
    double depth = core - floor;
    for (int i = 1; i <= kCompared; ++i) {
      const double u = static_cast<double>(i) / kCompared;  // circles closer together toward the floor
      const double r = floor + (radius - floor) * u * u;
      const auto ground = other.arc(x, r);
      if (!ground) continue;
      const auto own = sweep.arc(x, r);
      for (const bool high : {false, true}) {
        const double angle = high ? ground->high : ground->low;
        // The distance to the flute is at most the distance to its wall along the circle.
        const double along = own ? r * (high ? angle - own->high : own->low - angle) : core - r;
        if (own ? along > std::max(depth, min) : core < radius)
          depth = std::max(depth, distance(x, r, angle, core, along));
      }
    }
    return depth;
  }

 private:
  /// The distance from a point to the nearest of the flute's walls, which continue above the blank by `above`.
  double distance(double x, double r, double angle, double core, double above) const {
    const double highest = std::min(cutter.radius(x) + above, 2 * cutter.radius(x) - core) - core;
    double nearest = std::numeric_limits<double>::max();
    for (const bool high : {false, true}) {
      const auto to = [&](double place) {
        const double part = place / kPlacesOfWall, of = core + highest * part * part;
        const auto wall = sweep.wall(x, of, high);
        if (!wall) return std::numeric_limits<double>::max();
        const double half = std::sin((wall->angle - angle) / 2);
        return std::hypot(of - r, 2 * std::sqrt(of * r) * half);
      };
      int best = 1;
      double min = to(best);
      for (int i = 2; i <= kPlacesOfWall; ++i) {
        const double here = to(i);
        if (here < min) min = here, best = i;
      }
      std::uintmax_t steps = kNearestSteps;
      const auto found =
          boost::math::tools::brent_find_minima(to, best - 1.0, std::min(best + 1.0, kPlacesOfWall * 1.0), 26, steps);
      nearest = std::min({nearest, min, found.second});
    }
    return nearest;
  }
};

/// How far a position off a straight stroke is within the tool: through the plane, or the bottom of a gash [m].
double beyondPlane(const GrindJob& job, int tooth, const PathDeviation& off) {
  const double sin = std::sin(job.process().setup_swivel), cos = std::cos(job.process().setup_swivel);
  const double along_spindle = -sin * off.x + cos * off.z;
  if (job.process().kind != OperationKind::kGash) return -along_spindle;
  // What is off a stroke is at right angles to it, and the bottom runs along it.
  const double below_bottom = -off.y / std::cos(gashBottomOf(job, tooth).angle);
  return std::max(job.cutter.cut == CutDirection::kRightHand ? along_spindle : -along_spindle, below_bottom);
}

std::vector<Gouge> gougesOnEnd(const RunStrokes& strokes, double min) {
  std::vector<Gouge> gouges;
  for (const RunStroke& stroke : strokes.strokes()) {
    Gouge worst{stroke.place, stroke.move, 0, 0};
    for (const PathDeviation& off : stroke.deviations) {
      worst.depth = std::max(worst.depth, beyondPlane(*strokes.job(), stroke.place.tooth, off));
    }
    if (worst.depth > min) gouges.push_back(worst);
  }
  return gouges;
}

}  // namespace

std::vector<Gouge> gougesOf(const RunStrokes& strokes, double min) {
  const ValidJob& job = strokes.job();
  if (job.isStraight()) return gougesOnEnd(strokes, min);
  const GroundCutter asked = groundCutterOf(job);
  const Range blank{0, job->cutter.flute_length + job->process().overtravel_shank};
  std::vector<Gouge> gouges;
  for (const RunStroke& stroke : strokes.strokes()) {
    const GroundTooth& tooth = asked.teeth()[static_cast<std::size_t>(stroke.place.tooth)];
    const Reliefs& reliefs = asked.reliefs(static_cast<std::size_t>(stroke.place.tooth));
    const Asked flute{reliefs.empty() ? asked.flutes()[tooth.flute].front() : reliefs.back().front(),
                      ConicalCutter(job.cutterOf(stroke.place.tooth))};
    const WheelSweep sweep = strokes.sweep(stroke);
    Gouge worst{stroke.place, stroke.move, 0, 0};
    for (const double x : sectionsOf(stroke, blank)) {
      const double depth = flute.gouge(sweep, x, std::max(min, worst.depth));
      if (depth > worst.depth) worst.x = x, worst.depth = depth;
    }
    if (!(worst.depth > min)) continue;
    const bool same = !gouges.empty() && gouges.back().place == worst.place && gouges.back().move == worst.move;
    if (!same) {
      gouges.push_back(worst);
    } else if (worst.depth > gouges.back().depth) {
      gouges.back() = worst;
    }
  }
  return gouges;
}

}  // namespace grinder
