#include "geometry/relief_section.h"

#include "geometry/tooth_land.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr int kRadiusRings = 12;           ///< between which a search among radii looks for a change
constexpr int kRadiusSteps = 20;           ///< of one between two of them
constexpr double kRadiusAccuracy = 10e-9;  ///< of that [m]
constexpr int kNextEdgeRings = 4;          ///< on which the next tooth is looked at
constexpr double kFloor = 0.1;             ///< of the next flute's depth, which is no longer its rake face
constexpr double kBelowTheEdge = 1e-5;     ///< of the radius, where a relief is looked at first
constexpr double kNone = std::numeric_limits<double>::infinity();

/// From a place at the blank's radius to one that is so far behind it, in a straight line across the section.
double distance(double radius, double r, double behind) {
  return std::hypot(r * std::cos(behind) - radius, r * std::sin(behind));
}

double clearanceOf(double r, const ToothLand::Surface& surface) { return std::atan2(1, -r * surface.slope); }

/// Where a function of the radius, on the way from one to a lesser one, first is not negative.
/// @return nothing if it is negative all the way.
template <typename Function>
std::optional<double> crossing(double outer, double inner, const Function& f) {
  double before = outer, at_before = f(outer);
  if (!(at_before < 0)) return outer;
  for (int i = 1; i <= kRadiusRings; ++i) {
    const double r = outer + (inner - outer) * i / kRadiusRings, at = f(r);
    if (at >= 0) {
      std::uintmax_t steps = kRadiusSteps;
      const auto close = [](double a, double b) { return std::abs(a - b) < kRadiusAccuracy; };
      const auto [low, high] = boost::math::tools::toms748_solve(f, r, before, at, at_before, close, steps);
      return (low + high) / 2;
    }
    before = r, at_before = at;
  }
  return std::nullopt;
}

/// The land that the reliefs of a tooth leave in a section.
class RelievedLand {
 public:
  RelievedLand(const ToothLand& tooth, const Reliefs& reliefs, double x, double radius)
      : tooth_(tooth), reliefs_(reliefs) {
    for (const Relief& relief : reliefs) least_.push_back(leastRadius(relief, x, radius));
  }

  /// The least radius that is left.
  double core() const { return *std::min_element(least_.begin(), least_.end()); }

  /// No relief reaches a circle below this one.
  double lowest(std::size_t relief) const { return least_[relief] * (1 + kBelowTheEdge); }

  /// How far behind the edge a relief begins on a circle; infinite if it does not reach that.
  double begin(std::size_t relief, double r) const {
    const auto surface = r < lowest(relief) ? std::nullopt : tooth_.surface(reliefs_[relief], r);
    return surface ? surface->behind : kNone;
  }

  /// The land's surface is what begins nearest to the edge.
  double begin(double r) const {
    double nearest = kNone;
    for (std::size_t i = 0; i < reliefs_.size(); ++i) nearest = std::min(nearest, begin(i, r));
    return nearest;
  }

  /// How far behind the edge the reliefs reach on a circle.
  double end(double r) const {
    double farthest = -kNone;
    for (const Relief& relief : reliefs_) farthest = std::max(farthest, tooth_.farEnd(relief, r));
    return farthest;
  }

 private:
  const ToothLand& tooth_;
  const Reliefs& reliefs_;
  std::vector<double> least_;
};

/// The radius at which the land of a tooth meets the next flute: in front of the reliefs' end, or, where they take that
/// flute's wall away down to its floor, there.
/// @param foot of that wall. @param deepest circle that has a wall and a relief.
/// @return nothing if the reliefs end before.
std::optional<double> heelOf(const ToothLand& tooth, const RelievedLand& land, double outer, double foot,
                             double deepest) {
  const auto behind_flute = [&](double r) { return land.begin(r) - tooth.heelWall(r); };
  const auto short_of_flute = [&](double r) { return tooth.heelWall(r) - land.end(r); };
  const auto heel = crossing(outer, deepest, behind_flute);
  if (heel && short_of_flute(*heel) <= 0) return heel;
  if (!(short_of_flute(foot) < 0)) return std::nullopt;
  return crossing(foot, deepest, short_of_flute).value_or(deepest);
}

}  // namespace

ReliefSection measureRelief(const GroundCutter& cutter, const GroundSection& section, std::size_t number,
                            const Reliefs& reliefs) {
  const ToothLand tooth(cutter, section, number);
  const double radius = section.radius;
  const RelievedLand land(tooth, reliefs, section.x, radius);
  ReliefSection measured;
  measured.edge_radius = radius;
  measured.core_radius = land.core();
  const double below = radius * (1 - kBelowTheEdge);
  const auto first = tooth.surface(reliefs[0], below);
  if (!first) return measured;
  measured.clearance = clearanceOf(below, *first);
  // Where its surface, straight over so short a way, meets the edge.
  const double start = first->behind + first->slope * (radius - below);
  if (start < 0) measured.edge_radius = radius - start / first->slope;

  const double depth = section.teeth[cutter.next(number).tooth].depth;
  const double deepest = std::max(radius - depth, land.core()) * (1 + kBelowTheEdge);
  const double foot = std::max(deepest, radius - (1 - kFloor) * depth);
  const auto heel = heelOf(tooth, land, below, foot, deepest);
  if (heel) measured.heel = distance(radius, *heel, tooth.heelWall(*heel));
  const auto second_first = [&](double r) { return land.begin(0, r) - land.begin(1, r); };
  const auto land_end =
      reliefs.size() < 2 ? heel : crossing(below, std::max(land.lowest(0), land.lowest(1)), second_first);
  if (const auto end = land_end ? tooth.surface(reliefs[0], *land_end) : std::nullopt) {
    measured.land = distance(radius, *land_end, end->behind - std::max(0.0, start));
    measured.land_end_clearance = clearanceOf(*land_end, *end);
  }

  measured.next_edge = kNone;
  for (int i = 0; i <= kNextEdgeRings; ++i) {
    const double r = below + (foot - below) * i / kNextEdgeRings;
    measured.next_edge = std::min(measured.next_edge, tooth.nextRakeFace(r) - land.end(r));
  }
  return measured;
}

}  // namespace grinder
