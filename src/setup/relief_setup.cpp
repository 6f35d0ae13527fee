#include "setup/relief_setup.h"

#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/relief_section.h"
#include "flute_grinder/tool/tooth_land.h"
#include "flute_grinder/tool/z_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace grinder {

namespace {

using units::kDegree;

constexpr double kSameAngle = 1e-9;
constexpr double kSwivelStep = 2 * kDegree;
constexpr double kReachMargin = 0.02;            ///< ample margin of the rim beyond the relief's end, per end diameter
constexpr double kNextEdgeMargin = 1 * kDegree;  ///< ample angle of the wheel from the next edge
/// The fraction of the margin that must be left, above the rounding of a file, and the fractions that are tried if
/// there is no room for all of it.
constexpr double kLeastMargin = 0.02, kLessMargins[] = {0.1, 0.25, 0.5};
constexpr double kHopeless = -5;                   ///< slack below which nothing else is measured
constexpr int kCornerHalvings = 5;                 ///< halvings of a corner, a part of which may grind the land's end
constexpr double kLeastClearance = 0.5 * kDegree;  ///< minimum clearance at the land's end
constexpr double kAlongStep = 0.025;               ///< step along the rim toward the land's end, per end diameter
constexpr double kWidest = 5;                      ///< maximum width of a rim, per end diameter
constexpr int kHalvings = 40;
constexpr int kSectionsOfFlute = 3;
constexpr int kPlacesOfWall = 12;     ///< intervals in which a flute's wall is straight enough
constexpr std::size_t kAtOnce = 8;    ///< number of swivels tried at once
constexpr std::size_t kRefined = 3;   ///< number of the best swivels that are refined
constexpr int kRefinements = 7;       ///< steps between these swivels and their neighbours
constexpr double kGolden = 0.618034;  ///< remaining fraction after each step
constexpr int kPlacesOfRim = 16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string figure(double si, Unit unit) { return text(Quantity{si, unit}); }

/// The land behind a tooth in a section; one of several equal lands.
struct Land {
  GroundSection section;
  std::size_t tooth;
  std::vector<double> wall;  ///< wall of the next flute at the heel, from the core to the edge's circle

  double heelWall(double r) const {
    const double part = (r - section.core_radius) / (section.radius - section.core_radius);
    const double at = std::clamp(part, 0.0, 1.0) * kPlacesOfWall;
    const auto i = std::min(static_cast<std::size_t>(at), wall.size() - 2);
    return wall[i] + (at - static_cast<double>(i)) * (wall[i + 1] - wall[i]);
  }
};

std::vector<std::size_t> unlikeTeeth(const GroundCutter& cutter) {
  const auto& teeth = cutter.teeth();
  std::vector<std::tuple<std::size_t, std::size_t, double>> seen;
  std::vector<std::size_t> unlike;
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    for (const std::size_t next : {(i + 1) % teeth.size(), (i + teeth.size() - 1) % teeth.size()}) {
      const double turn = std::remainder(teeth[next].angle - teeth[i].angle, units::kTurn);
      const auto tooth = std::make_tuple(teeth[i].flute, teeth[next].flute, std::round(turn / kSameAngle));
      if (std::find(seen.begin(), seen.end(), tooth) != seen.end()) continue;
      seen.push_back(tooth);
      if (unlike.empty() || unlike.back() != i) unlike.push_back(i);
    }
  }
  return unlike;
}

Land landOf(const GroundCutter& cutter, const GroundSection& section, std::size_t tooth) {
  if (!section.teeth[tooth].edge) throw std::invalid_argument("no edge at X = " + figure(section.x, Unit::kMetre));
  const ToothLand land(cutter, section, tooth);
  std::vector<double> wall;
  for (int i = 0; i <= kPlacesOfWall; ++i) {
    wall.push_back(land.heelWall(section.core_radius + (section.radius - section.core_radius) * i / kPlacesOfWall));
  }
  wall[0] = wall[1];  // the floor has no wall
  return {section, tooth, std::move(wall)};
}

std::vector<Land> landsOf(const GroundCutter& cutter) {
  const double length = cutter.cutter().cone().flute_length;
  std::vector<Land> lands;
  for (int i = 0; i < kSectionsOfFlute; ++i) {
    const GroundSection section = cutter.section(length * i / (kSectionsOfFlute - 1));
    for (const std::size_t tooth : unlikeTeeth(cutter)) lands.push_back(landOf(cutter, section, tooth));
  }
  return lands;
}

/// The distance along the rim at which `is_over` becomes true.
/// @return nothing if the clearance is lost before.
template <typename Over>
std::optional<double> reachTo(const ReliefPath& path, double x, double diameter, const Over& is_over) {
  const double step = kAlongStep * diameter;
  for (double along = step; along < kWidest * diameter; along += step) {
    const ReliefPath::Place at = path.surface(x, along);
    if (!is_over(at)) {
      if (!(at.clearance >= kLeastClearance)) return std::nullopt;
      continue;
    }
    double low = along - step, high = along;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (low + high) / 2;
      (is_over(path.surface(x, middle)) ? high : low) = middle;
    }
    return path.surface(x, high).clearance >= kLeastClearance ? std::optional(high) : std::nullopt;
  }
  return std::nullopt;
}

/// A trial set-up.
struct Tried {
  ReliefSetup setup;
  double slack = -kInfinity;  ///< minimum of its margins, relative to ample ones; 0 or less if it is refused
  double next_edge_slack = -kInfinity;
  bool has_heel = false;
};

/// Tries set-ups of a relief.
class Trials {
 public:
  Trials(const GrindJob& job, const ValidJob& flutes)
      : job_(job), flutes_(flutes), edges_(edgesOf(flutes)), lands_(landsOf(groundCutterOf(flutes))) {
    const GrindProcess* next = job.next();
    land_ = next != nullptr && isRelief(next->kind) ? job.cutter.land : 0;
    for (const Land& land : lands_) {
      CutterGeometry geometry = job.cutter;
      geometry.spiral_angle = edges_[land.tooth].spiral_angle;
      teeth_.emplace_back(geometry);
      starts_.push_back(reliefStartOf(job, teeth_.back()));
    }
  }

  /// The best set-up with a swivel, judged by some sections.
  Tried best(double swivel) const {
    Tried best;
    best.setup.swivel = swivel;
    try {
      const Needs needs = needsAt(swivel);
      const double whole = kReachMargin * job_.cutter.end_diameter;
      const auto take = [&](Tried tried) {
        if (tried.slack > best.slack) best = std::move(tried);
      };
      take(at(swivel, needs, whole, whole));
      if (best.slack >= 1) return best;
      const double least = leastMargin(swivel, needs, whole);
      take(at(swivel, needs, least, whole));
      if (!(best.slack > 0)) return best;
      for (const double part : kLessMargins) take(at(swivel, needs, least + part * whole, whole));
    } catch (const std::invalid_argument& error) {
      if (best.setup.refused.empty()) best.setup.refused = error.what();
    }
    return best;
  }

  /// The best set-up with a swivel, with the relief's start anywhere on the rim. The measurements count, not the width
  /// of the rim: the wheel's faces may grind what the rim does not.
  Tried anywhere(double swivel) const {
    Tried best;
    for (int i = 1; i < kPlacesOfRim; ++i) {
      Tried tried;
      tried.setup.swivel = swivel;
      ReliefWheel wheel = wheelAt(swivel);
      const double along = wheel.width * (static_cast<double>(i) / kPlacesOfRim - 0.5);
      try {
        wheel.height = tried.setup.height = ReliefPath::heightFor(teeth_[0], starts_[0], wheel, along);
        tried.setup.width = ReliefPath(teeth_[0], starts_[0], wheel).reach();
        measure(tried, 1, true);
      } catch (const std::invalid_argument&) {
        continue;  // an edge is not on the rim
      }
      if (tried.slack > best.slack) best = std::move(tried);
    }
    return best;
  }

  /// Whether the plan's check, which measures more sections, accepts a set-up. A refused set-up has no slack.
  bool isConfirmed(Tried& tried) const {
    if (!(tried.slack > 0)) return false;
    const CutterCheck check = checkGroundCutter(jobWith(tried.setup));
    if (check.reasons.empty()) return true;
    tried.slack = 0;
    tried.setup.refused = text(check.reasons);
    return false;
  }

 private:
  /// The requirements of the reliefs behind all lands.
  struct Needs {
    std::vector<double> reach;  ///< width of rim behind the relief's start, for each land [m]
    Range clearance{kInfinity, -kInfinity};
  };

  Needs needsAt(double swivel) const {
    Needs needs;
    const double diameter = job_.cutter.end_diameter;
    for (std::size_t i = 0; i < lands_.size(); ++i) {
      const Land& land = lands_[i];
      ReliefWheel wide = wheelAt(swivel);
      wide.width = 2 * kWidest * diameter;
      wide.corner_radius = {};
      wide.height = ReliefPath::heightFor(teeth_[i], starts_[i], wide, 0);
      const ReliefPath path(teeth_[i], starts_[i], wide);
      const double x = land.section.x, width = land_ * land.section.radius / (diameter / 2);
      const ReliefPath::Place from = path.surface(x, 0);
      const auto is_wide = [&](const ReliefPath::Place& at) {
        const double turn = at.behind - from.behind;
        return std::hypot(at.radius * std::cos(turn) - from.radius, at.radius * std::sin(turn)) >= width;
      };
      const auto is_at_heel = [&](const ReliefPath::Place& at) { return at.behind >= land.heelWall(at.radius); };
      const auto reach = land_ > 0 ? reachTo(path, x, diameter, is_wide) : reachTo(path, x, diameter, is_at_heel);
      if (!reach) throw std::invalid_argument("the clearance is lost before the land's end");
      needs.reach.push_back(*reach);
      const double clearance = path.surface(x, *reach).clearance;
      needs.clearance = {std::min(needs.clearance.from, clearance), std::max(needs.clearance.to, clearance)};
    }
    return needs;
  }

  ReliefWheel wheelAt(double swivel) const {
    ReliefWheel wheel = reliefWheelOf(job_.process());
    wheel.swivel = swivel;
    return wheel;
  }

  /// A height with which the rim reaches over every land, and its reach over the land that needs most.
  std::pair<double, double> heightAt(double swivel, const Needs& needs, double margin) const {
    ReliefWheel wheel = wheelAt(swivel);
    const auto reaches = [&](double height) {
      wheel.height = height;
      for (std::size_t i = 0; i < lands_.size(); ++i) {
        if (!(ReliefPath(teeth_[i], starts_[i], wheel).reach() >= needs.reach[i] + margin - kSameReach)) return false;
      }
      return true;
    };
    // The teeth of one helix need the same height for the same reach.
    std::vector<std::size_t> by_need(lands_.size());
    std::iota(by_need.begin(), by_need.end(), 0);
    std::stable_sort(by_need.begin(), by_need.end(),
                     [&](std::size_t a, std::size_t b) { return needs.reach[a] > needs.reach[b]; });
    for (const std::size_t i : by_need) {
      const double reach = std::max(0.0, needs.reach[i] + margin);
      const double height = ReliefPath::heightForReach(teeth_[i], starts_[i], wheel, reach);
      if (reaches(height)) return {height, reach};
    }
    throw std::invalid_argument("no height has every edge on the rim, and the rim over every land");
  }

  /// The minimum margin of the rim with which the relief reaches every heel. Negative if a corner of the wheel grinds
  /// the land's end.
  double leastMargin(double swivel, const Needs& needs, double whole) const {
    const double rounding = kLeastMargin * whole;
    const double corner = std::max(job_.process().wheel_corner_radius_lower, job_.process().wheel_corner_radius_upper);
    if (land_ > 0 || corner == 0) return rounding;
    double low = -corner, high = rounding;
    if (!(at(swivel, needs, low, whole).next_edge_slack > 0)) return rounding;
    for (int i = 0; i < kCornerHalvings; ++i) {
      const double middle = (low + high) / 2;
      (at(swivel, needs, middle, whole).has_heel ? high : low) = middle;
    }
    return high + rounding;
  }

  /// @param margin margin of the rim beyond the lands' ends [m].
  /// @param whole ample margin [m].
  Tried at(double swivel, const Needs& needs, double margin, double whole) const {
    Tried tried;
    tried.setup.swivel = swivel;
    const double most = *std::max_element(needs.reach.begin(), needs.reach.end()) + margin;
    const ReliefWheel wheel = wheelAt(swivel);
    const double rim = wheel.width - wheel.corner_radius[0] - wheel.corner_radius[1];
    if (most > rim) {
      tried.slack = (rim - most) / whole - 1;
      tried.setup.refused = "the relief needs a rim " + figure(most, Unit::kMetre) + " wide, that of this wheel is " +
                            figure(rim, Unit::kMetre);
      return tried;
    }
    std::tie(tried.setup.height, tried.setup.width) = heightAt(swivel, needs, margin);
    tried.setup.land_end_clearance = needs.clearance;
    measure(tried, margin / whole);
    return tried;
  }

  /// @param margin margin of the rim, relative to an ample one.
  /// @param good_only whether to stop measuring as soon as the set-up is refused, rather than hopeless.
  void measure(Tried& tried, double margin, bool good_only = false) const {
    const GroundCutter cutter = groundCutterOf(jobWith(tried.setup));
    const CutterGeometry& c = job_.cutter;
    tried.has_heel = true;
    tried.next_edge_slack = kInfinity;
    double core_slack = kInfinity;
    for (const Land& land : lands_) {
      const ReliefSection relief = measureRelief(cutter, land.section, land.tooth, cutter.reliefs(land.tooth));
      tried.has_heel = tried.has_heel && (land_ > 0 || relief.heel);
      tried.next_edge_slack = std::min(tried.next_edge_slack, relief.next_edge / kNextEdgeMargin);
      if (tried.next_edge_slack < (good_only ? 0 : kHopeless) || (good_only && !tried.has_heel)) break;
      const double core = 2 * relief.core_radius, least = askedCore(c, land.section.x) - c.core_tolerance;
      const double slack = (core - least) / c.core_tolerance;
      if (core >= std::min(least, 2 * land.section.core_radius) || slack >= core_slack) continue;
      core_slack = slack;
      tried.setup.refused = "the wheel leaves a core of " + figure(core, Unit::kMetre) +
                            " at X = " + figure(land.section.x, Unit::kMetre) + "; allowed: from " +
                            figure(least, Unit::kMetre);
    }
    tried.setup.next_edge = tried.next_edge_slack * kNextEdgeMargin;
    tried.slack = std::min(tried.next_edge_slack, core_slack);
    if (tried.setup.next_edge <= 0) {
      tried.setup.refused =
          "the wheel reaches " + figure(-tried.setup.next_edge, Unit::kRadian) + " beyond the next edge";
    } else if (!tried.has_heel) {
      tried.setup.refused = "the relief ends on the land";
    }
    // Where a corner grinds the land's end, the margin is the part above the minimum.
    tried.slack = std::min(tried.slack, tried.has_heel ? std::max(margin, kLeastMargin) : -kLeastMargin);
  }

  ValidJob jobWith(const ReliefSetup& setup) const {
    GrindJob job = job_;
    job.process().setup_swivel = setup.swivel;
    job.process().setup_height = setup.height;
    job.operations[static_cast<std::size_t>(job.operation)] = job.process();
    return ValidJob(std::move(job)).withEdges(flutes_, edges_);
  }

  static constexpr double kSameReach = 1e-12;  ///< [m]

  const GrindJob& job_;
  const ValidJob& flutes_;
  const std::vector<EdgeHelix> edges_;
  const std::vector<Land> lands_;
  double land_;                       ///< land at the small end, before another relief; 0: up to the heel [m]
  std::vector<ConicalCutter> teeth_;  ///< teeth of the lands
  std::vector<ReliefStart> starts_;   ///< starts of the relief on the lands
};

/// The best swivel between two others, if one in between is better than both.
Tried refined(const Trials& trials, double from, double to, Tried best) {
  for (int i = 0; i < kRefinements; ++i) {
    const double middle = best.setup.swivel;
    const bool above = to - middle > middle - from;
    Tried beside = trials.best(middle + (1 - kGolden) * (above ? to - middle : from - middle));
    if (beside.slack > best.slack) {
      (above ? from : to) = middle;
      best = std::move(beside);
    } else {
      (above ? to : from) = beside.setup.swivel;
    }
  }
  return best;
}

}  // namespace

ReliefSetup findReliefSetup(const GrindJob& job, const ValidJob& flutes, const Range& swivel,
                            std::optional<double> asked) {
  const Trials trials(job, flutes);
  if (asked) {
    Tried tried = trials.best(*asked);
    if (trials.isConfirmed(tried)) return tried.setup;
    Tried other = trials.anywhere(*asked);
    return trials.isConfirmed(other) ? other.setup : tried.setup;
  }
  const double near = std::clamp(flutes->process().setup_swivel, swivel.from, swivel.to);
  std::vector<double> swivels{near, job.process().setup_swivel};
  for (double aside = kSwivelStep; aside <= swivel.to - swivel.from; aside += kSwivelStep) {
    swivels.push_back(near + aside);
    swivels.push_back(near - aside);
  }
  const auto is_beyond = [&](double one) { return !(one >= swivel.from && one <= swivel.to); };
  swivels.erase(std::remove_if(swivels.begin(), swivels.end(), is_beyond), swivels.end());
  std::stable_sort(swivels.begin(), swivels.end(),
                   [near](double a, double b) { return std::abs(a - near) < std::abs(b - near); });
  std::vector<Tried> all;
  while (all.size() < swivels.size()) {
    const std::size_t from = all.size(), count = from == 0 ? 1 : std::min(kAtOnce, swivels.size() - from);
    all.resize(from + count);
    onAllCores(count, [&](std::size_t i) { all[from + i] = trials.best(swivels[from + i]); });
    for (std::size_t i = from; i < all.size(); ++i) {
      if (all[i].slack >= 1 && trials.isConfirmed(all[i])) return all[i].setup;
    }
  }
  const Tried nearest = all.front();
  const auto more_slack = [](const Tried& a, const Tried& b) { return a.slack > b.slack; };
  std::stable_sort(all.begin(), all.end(), more_slack);
  all.resize(std::min(kRefined, all.size()));
  onAllCores(all.size(), [&](std::size_t i) {
    const double middle = all[i].setup.swivel;
    all[i] =
        refined(trials, std::max(swivel.from, middle - kSwivelStep), std::min(swivel.to, middle + kSwivelStep), all[i]);
  });
  std::stable_sort(all.begin(), all.end(), more_slack);
  for (Tried& best : all) {
    if (trials.isConfirmed(best)) return best.setup;
  }
  all.resize(swivels.size());
  onAllCores(all.size(), [&](std::size_t i) { all[i] = trials.anywhere(swivels[i]); });
  std::stable_sort(all.begin(), all.end(), more_slack);
  for (Tried& best : all) {
    if (trials.isConfirmed(best)) return best.setup;
  }
  return nearest.setup;
}

}  // namespace grinder
