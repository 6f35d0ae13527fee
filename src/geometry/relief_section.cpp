#include "flute_grinder/geometry/relief_section.h"

#include "flute_grinder/curve/units.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr int kRadiusSteps = 20;           ///< of a search among radii
constexpr double kRadiusAccuracy = 10e-9;  ///< of that [m]
constexpr int kNextEdgeRings = 4;          ///< on which the next tooth is looked at
constexpr double kBelowTheEdge = 1e-4;     ///< of the radius, where a relief is looked at first

/// One tooth, whose angles are counted from its edge toward its heel.
class Tooth {
 public:
  Tooth(const GroundCutter& cutter, const GroundSection& section, std::size_t number,
        const std::vector<WheelSweep>& reliefs)
      : cutter_(cutter),
        reliefs_(reliefs),
        x_(section.x),
        right_(cutter.direction() == CutDirection::kRightHand),
        angle_(cutter.teeth()[number].angle),
        edge_(*section.teeth[number].edge - angle_) {
    const std::size_t count = cutter.teeth().size();
    const std::size_t next = right_ ? (number + 1) % count : (number + count - 1) % count;
    const double pitch = behind(cutter.teeth()[next].angle - angle_ + edge_);
    pitch_ = pitch > 0 ? pitch : pitch + units::kTurn;
    next_flute_ = &cutter.flutes()[cutter.teeth()[next].flute];
  }

  double behind(double angle) const { return right_ ? angle - edge_ : edge_ - angle; }

  /// Where a relief's surface meets a circle, by its slope over the radius.
  struct Surface {
    double behind, slope;
  };
  std::optional<Surface> surface(std::size_t relief, double r) const {
    const auto wall = reliefs_[relief].wall(x_, r, !right_);
    if (!wall) return std::nullopt;
    return Surface{behind(wall->angle), right_ ? wall->slope : -wall->slope};
  }

  /// The next flute's wall at the heel, on a circle that it reaches.
  double heelWall(double r) const { return wallOf(*next_flute_, r, !right_).value_or(0) + pitch_; }
  double nextRakeFace(double r) const { return wallOf(*next_flute_, r, right_).value_or(0) + pitch_; }

  /// Where a relief ends, far behind the edge; before everything where it does not reach the circle.
  double farEnd(std::size_t relief, double r) const {
    const auto wall = reliefs_[relief].wall(x_, r, right_);
    return wall ? behind(wall->angle) : -units::kTurn;
  }

  /// From the edge at the blank's radius, in a straight line across the section.
  double distance(double radius, double r, double at) const {
    return std::hypot(r * std::cos(at) - radius, r * std::sin(at));
  }

 private:
  std::optional<double> wallOf(const Flute& flute, double r, bool high) const {
    std::optional<double> farthest;
    for (const WheelSweep& sweep : flute) {
      const auto wall = sweep.wall(x_, r, high);
      if (!wall) continue;
      farthest = !farthest ? wall->angle : high ? std::max(*farthest, wall->angle) : std::min(*farthest, wall->angle);
    }
    if (farthest) farthest = behind(*farthest);
    return farthest;
  }

  const GroundCutter& cutter_;
  const std::vector<WheelSweep>& reliefs_;
  double x_;
  bool right_;
  double angle_, edge_, pitch_ = 0;
  const Flute* next_flute_ = nullptr;
};

double clearanceOf(double r, const Tooth::Surface& surface) { return std::atan2(1, -r * surface.slope); }

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
                            const std::vector<WheelSweep>& reliefs) {
  const Tooth tooth(cutter, section, number, reliefs);
  const double radius = section.radius;
  ReliefSection measured;
  measured.edge_radius = radius;
  const double below = radius * (1 - kBelowTheEdge);
  const auto first = tooth.surface(0, below);
  if (!first) return measured;
  measured.clearance = clearanceOf(below, *first);
  // Where its surface, straight over so short a way, meets the edge.
  const double start = first->behind + first->slope * (radius - below);
  if (start < 0) measured.edge_radius = radius - start / first->slope;

  // The land's surface is what begins nearest to the edge. No relief reaches a circle below the least that it leaves.
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> lowest;
  for (const WheelSweep& relief : reliefs) lowest.push_back(relief.minRadius(section.x, radius) * (1 + kBelowTheEdge));
  const auto start_of = [&](std::size_t relief, double r) {
    const auto surface = r < lowest[relief] ? std::nullopt : tooth.surface(relief, r);
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
    for (std::size_t i = 0; i < reliefs.size(); ++i) reaches = reaches || tooth.farEnd(i, *heel) >= wall;
    if (reaches) measured.heel = tooth.distance(radius, *heel, wall);
  }
  const auto second_first = [&](double r) { return start_of(0, r) - start_of(1, r); };
  const auto land_end = reliefs.size() < 2 ? heel : crossing(below, std::max(lowest[0], lowest[1]), second_first);
  if (const auto end = land_end ? tooth.surface(0, *land_end) : std::nullopt) {
    measured.land = tooth.distance(radius, *land_end, end->behind);
    measured.land_end_clearance = clearanceOf(*land_end, *end);
  }

  measured.next_edge = kNone;
  for (int i = 0; i <= kNextEdgeRings; ++i) {
    const double r = below + (deepest - below) * i / kNextEdgeRings;
    const double face = tooth.nextRakeFace(r);
    for (std::size_t k = 0; k < reliefs.size(); ++k) {
      measured.next_edge = std::min(measured.next_edge, face - tooth.farEnd(k, r));
    }
  }
  return measured;
}

}  // namespace grinder
