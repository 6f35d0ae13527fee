#include "flute_grinder/tool/relief_section.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/tooth_land.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr int kRadiusRings = 12;          ///< rings between which a search among radii looks for a change
constexpr int kRadiusSteps = 20;          ///< steps of a search between two rings
constexpr double kRadiusAccuracy = 1e-9;  ///< accuracy of such a search [m]
constexpr int kNextEdgeRings = 4;         ///< rings on which the next tooth is examined
constexpr double kFloor = 0.1;            ///< lowest fraction of the next flute that is not its rake face
constexpr double kBelowTheEdge = 1e-5;    ///< depth below the edge at which a relief is examined, per radius
constexpr double kSameBegin = 1e-9;       ///< angle by which a relief at the edge may begin before it [rad]
constexpr double kNone = std::numeric_limits<double>::infinity();

/// A point of a section, with its angle behind the edge's place on the blank's circle.
struct LandPlace {
  double radius, behind;
};

double distance(const LandPlace& a, const LandPlace& b) {
  const double turn = b.behind - a.behind;
  return std::hypot(b.radius * std::cos(turn) - a.radius, b.radius * std::sin(turn));
}

double clearanceOf(double r, const ToothLand::Surface& surface) { return std::atan2(1, -r * surface.slope); }

/// The first radius, from `outer` to `inner`, at which a function of it is not negative.
/// @return nothing if it is negative everywhere.
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

  /// The minimum radius that is left.
  double core() const { return *std::min_element(least_.begin(), least_.end()); }

  /// The radius below which a relief reaches no circle.
  double lowest(std::size_t relief) const { return least_[relief] * (1 + kBelowTheEdge); }

  /// A relief's surface on a circle, if it reaches the circle.
  std::optional<ToothLand::Surface> surface(std::size_t relief, double r) const {
    return r < lowest(relief) ? std::nullopt : tooth_.surface(reliefs_[relief], r);
  }

  /// The land's surface on a circle: the surface that begins nearest to the edge.
  std::optional<ToothLand::Surface> surface(double r) const {
    std::optional<ToothLand::Surface> nearest;
    for (std::size_t i = 0; i < reliefs_.size(); ++i) {
      const auto here = surface(i, r);
      if (here && (!nearest || here->behind < nearest->behind)) nearest = here;
    }
    return nearest;
  }

  /// The angle behind the edge at which a surface begins; a whole turn if there is none.
  static double begin(const std::optional<ToothLand::Surface>& surface) {
    return surface ? surface->behind : units::kTurn;
  }

  /// The maximum angle behind the edge that the reliefs reach on a circle.
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

/// The radius of the edge: the first radius, from the blank's circle inward, at which the rake face is in front of the
/// reliefs.
/// @param lowest radius of the lowest circle that the rake face reaches.
double edgeOf(const ToothLand& tooth, const RelievedLand& land, double radius, double lowest) {
  const auto in_front = [&](double r) { return land.begin(land.surface(r)) - tooth.rakeFace(r) + kSameBegin; };
  return crossing(radius, lowest, in_front).value_or(lowest);
}

/// The radius at which the land of a tooth meets the next flute: in front of the reliefs' end, or, if they remove that
/// flute's wall down to its floor, at the floor.
/// @param foot foot of that wall.
/// @param deepest radius of the deepest circle that has a wall and a relief.
/// @return nothing if the reliefs end before it.
std::optional<double> heelOf(const ToothLand& tooth, const RelievedLand& land, double outer, double foot,
                             double deepest) {
  const auto behind_flute = [&](double r) { return land.begin(land.surface(r)) - tooth.heelWall(r); };
  const auto short_of_flute = [&](double r) { return tooth.heelWall(r) - land.end(r); };
  const auto heel = crossing(outer, deepest, behind_flute);
  if (heel && short_of_flute(*heel) <= 0) return heel;
  if (!(short_of_flute(foot) < 0)) return std::nullopt;
  return crossing(foot, deepest, short_of_flute).value_or(deepest);
}

/// The radius at which the second relief begins, from a circle inward.
std::optional<double> secondBegin(const RelievedLand& land, double outer) {
  const auto first_ends = [&](double r) { return land.begin(land.surface(0, r)) - land.begin(land.surface(1, r)); };
  return crossing(outer, std::max(land.lowest(0), land.lowest(1)), first_ends);
}

/// Measures the first relief's land.
/// @param below radius below the edge at which the relief is examined.
/// @param end radius at which it ends.
void measureLand(const ToothLand& tooth, const Reliefs& reliefs, const LandPlace& edge, double below, double end,
                 ReliefSection& measured) {
  const auto last = tooth.surface(reliefs[0], end);
  if (!last) return;
  // The relief begins where its surface, straight over this distance, is as high as the edge; in front of it is the
  // blank.
  const auto first = tooth.surface(reliefs[0], below);
  const double begin = first ? first->behind + first->slope * (edge.radius - below) : 0;
  measured.land = distance({edge.radius, std::max(edge.behind, begin)}, {end, last->behind});
  measured.land_end_clearance = clearanceOf(end, *last);
  const auto second = reliefs.size() < 2 ? std::nullopt : tooth.surface(reliefs[1], end);
  if (second) measured.second_clearance = clearanceOf(end, *second);
}

}  // namespace

ReliefSection measureRelief(const GroundCutter& cutter, const GroundSection& section, std::size_t number,
                            const Reliefs& reliefs) {
  const ToothLand tooth(cutter, section, number);
  const double radius = section.radius;
  const RelievedLand land(tooth, reliefs, section.x, radius);
  ReliefSection measured;
  measured.core_radius = land.core();
  const double depth = section.teeth[cutter.next(number).tooth].depth;
  const double deepest = std::max(radius - depth, land.core()) * (1 + kBelowTheEdge);
  const double foot = std::max(deepest, radius - (1 - kFloor) * depth);
  const double lowest = std::max(radius - section.teeth[number].depth, 0.0) * (1 + kBelowTheEdge);
  measured.edge_radius = edgeOf(tooth, land, radius, lowest);
  const double below = measured.edge_radius * (1 - kBelowTheEdge);
  if (const auto surface = land.surface(below)) measured.clearance = clearanceOf(below, *surface);

  const LandPlace edge{measured.edge_radius, tooth.rakeFace(measured.edge_radius)};
  const auto heel = heelOf(tooth, land, below, foot, deepest);
  if (heel) measured.heel = distance(edge, {*heel, tooth.heelWall(*heel)});
  const auto land_end = reliefs.size() < 2 ? heel : secondBegin(land, below);
  if (land_end) measureLand(tooth, reliefs, edge, below, *land_end, measured);

  measured.next_edge = kNone;
  for (int i = 0; i <= kNextEdgeRings; ++i) {
    const double r = below + (foot - below) * i / kNextEdgeRings;
    measured.next_edge = std::min(measured.next_edge, tooth.nextRakeFace(r) - land.end(r));
  }
  return measured;
}

}  // namespace grinder
