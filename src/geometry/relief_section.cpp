#include "geometry/relief_section.h"

#include "geometry/tooth_land.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr int kRadiusSteps = 20;           ///< of a search among radii
constexpr double kRadiusAccuracy = 10e-9;  ///< of that [m]
constexpr int kNextEdgeRings = 4;          ///< on which the next tooth is looked at
constexpr double kBelowTheEdge = 1e-5;     ///< of the radius, where a relief is looked at first

/// From a place at the blank's radius to one that is so far behind it, in a straight line across the section.
double distance(double radius, double r, double behind) {
  return std::hypot(r * std::cos(behind) - radius, r * std::sin(behind));
}

double clearanceOf(double r, const ToothLand::Surface& surface) { return std::atan2(1, -r * surface.slope); }

/// Where a function of the radius is 0, between one at which it is negative and a lesser one.
/// @return nothing if it is negative there, too.
template <typename Function>
std::optional<double> crossing(double outer, double inner, const Function& f) {
  const double at_outer = f(outer), at_inner = f(inner);
  if (!(at_inner >= 0)) return std::nullopt;
  if (!(at_outer < 0)) return outer;
  std::uintmax_t steps = kRadiusSteps;
  const auto close = [](double a, double b) { return std::abs(a - b) < kRadiusAccuracy; };
  const auto [low, high] = boost::math::tools::toms748_solve(f, inner, outer, at_inner, at_outer, close, steps);
  return (low + high) / 2;
}

}  // namespace

ReliefSection measureRelief(const GroundCutter& cutter, const GroundSection& section, std::size_t number,
                            const Reliefs& reliefs) {
  const ToothLand tooth(cutter, section, number);
  const double radius = section.radius;
  ReliefSection measured;
  measured.edge_radius = radius;
  const double below = radius * (1 - kBelowTheEdge);
  const auto first = tooth.surface(reliefs[0], below);
  if (!first) return measured;
  measured.clearance = clearanceOf(below, *first);
  // Where its surface, straight over so short a way, meets the edge.
  const double start = first->behind + first->slope * (radius - below);
  if (start < 0) measured.edge_radius = radius - start / first->slope;

  // The land's surface is what begins nearest to the edge. No relief reaches a circle below the least that it leaves.
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> lowest;
  for (const Relief& relief : reliefs) lowest.push_back(leastRadius(relief, section.x, radius) * (1 + kBelowTheEdge));
  const auto start_of = [&](std::size_t relief, double r) {
    const auto surface = r < lowest[relief] ? std::nullopt : tooth.surface(reliefs[relief], r);
    return surface ? surface->behind : kNone;
  };
  const auto land_at = [&](double r) {
    double nearest = kNone;
    for (std::size_t i = 0; i < reliefs.size(); ++i) nearest = std::min(nearest, start_of(i, r));
    return nearest;
  };
  const auto behind_flute = [&](double r) { return land_at(r) - tooth.heelWall(r); };
  const double deepest = std::max(section.core_radius, *std::min_element(lowest.begin(), lowest.end()));
  const auto heel = crossing(below, deepest, behind_flute);
  if (heel) {
    const double wall = tooth.heelWall(*heel);
    bool reaches = false;
    for (std::size_t i = 0; i < reliefs.size(); ++i) reaches = reaches || tooth.farEnd(reliefs[i], *heel) >= wall;
    if (reaches) measured.heel = distance(radius, *heel, wall);
  }
  const auto second_first = [&](double r) { return start_of(0, r) - start_of(1, r); };
  const auto land_end = reliefs.size() < 2 ? heel : crossing(below, std::max(lowest[0], lowest[1]), second_first);
  if (const auto end = land_end ? tooth.surface(reliefs[0], *land_end) : std::nullopt) {
    measured.land = distance(radius, *land_end, end->behind - std::max(0.0, start));
    measured.land_end_clearance = clearanceOf(*land_end, *end);
  }

  measured.next_edge = kNone;
  for (int i = 0; i <= kNextEdgeRings; ++i) {
    const double r = below + (deepest - below) * i / kNextEdgeRings;
    const double face = tooth.nextRakeFace(r);
    for (std::size_t k = 0; k < reliefs.size(); ++k) {
      measured.next_edge = std::min(measured.next_edge, face - tooth.farEnd(reliefs[k], r));
    }
  }
  return measured;
}

}  // namespace grinder
