#include "flute_grinder/geometry/gouge.h"

#include "flute_grinder/geometry/ground_job.h"

#include <algorithm>
#include <cmath>

namespace flute_grinder {

namespace {

constexpr int kEvenSections = 6;  ///< beside those where the axes were farthest off

/// X of the sections in which a stroke is measured.
std::vector<double> sectionsOf(const RecordedStroke& stroke, const Range& blank) {
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

/// What a job asks for of a tooth, as if at angle 0.
struct Asked {
  const WheelSweep& sweep;
  ConicalCutter cutter;

  /// How far another sweep goes beyond it in a section [m].
  double gouge(const WheelSweep& other, double x) const {
    const double radius = cutter.radius(x);
    const double core = std::min(radius, sweep.leastRadius(x, radius));
    double depth = core - std::min(radius, other.leastRadius(x, radius));
    for (const double r : {radius, (radius + core) / 2}) {
      for (const bool high : {false, true}) depth = std::max(depth, beyondWall(other, x, r, high));
    }
    return depth;
  }

 private:
  double beyondWall(const WheelSweep& other, double x, double r, bool high) const {
    const auto wall = sweep.wall(x, r, high), ground = other.wall(x, r, high);
    if (!wall || !ground) return 0;
    // Normal to the wall's tangent.
    const double turned = ground->angle - wall->angle, per_radius = r * wall->slope;
    const double beyond = r * (std::sin(turned) + per_radius * (1 - std::cos(turned))) / std::hypot(1, per_radius);
    return high ? beyond : -beyond;
  }
};

}  // namespace

std::vector<Gouge> gougesOf(const GrindJob& job, const RecordedStrokes& strokes, double least) {
  const GroundCutter asked = groundCutterOf(job);
  const Range blank{0, job.cutter.flute_length + job.process.overtravel_shank};
  std::vector<Gouge> gouges;
  for (const RecordedStroke& stroke : strokes.strokes()) {
    const GroundTooth& tooth = asked.teeth()[static_cast<std::size_t>(stroke.place.tooth)];
    const Asked flute{asked.flutes()[tooth.flute].front(), ConicalCutter(cutterOf(job, stroke.place.tooth))};
    const WheelSweep sweep = strokes.sweep(stroke);
    Gouge worst{stroke.place, stroke.move, 0, 0};
    for (const double x : sectionsOf(stroke, blank)) {
      const double depth = flute.gouge(sweep, x);
      if (depth > worst.depth) worst.x = x, worst.depth = depth;
    }
    if (!(worst.depth > least)) continue;
    const bool same = !gouges.empty() && gouges.back().place == worst.place && gouges.back().move == worst.move;
    if (!same) {
      gouges.push_back(worst);
    } else if (worst.depth > gouges.back().depth) {
      gouges.back() = worst;
    }
  }
  return gouges;
}

}  // namespace flute_grinder
