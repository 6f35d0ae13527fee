#include "flute_grinder/tool/section_outline.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace grinder {

namespace {

constexpr double kNearFloor = 1e-9;              ///< height above a flute's floor [m]
constexpr int kHeelRings = 16;                   ///< rings between which a land may meet the flute behind it
constexpr int kHeelHalvings = 26;                ///< halvings between two rings to find that place
constexpr double kBelowEdgeCircle = 1 - 1e-4;    ///< factor of the radius at which a relief is first examined
constexpr std::uintmax_t kMaxMeetingSteps = 60;  ///< maximum number of steps to find where two walls meet

double squared(double v) { return v * v; }

double roundedTurns(double turns) { return std::ldexp(std::nearbyint(std::ldexp(turns, 40)), -40); }

PolarPoint polar(double radius, double angle) { return {radius, roundedTurns(angle / units::kTurn)}; }

/// The walls of a flute in a section, for a tooth at angle 0. Each circle is computed once.
class FluteWalls {
 public:
  FluteWalls(const GroundCutter& cutter, const Flute& flute, double x, double blank_radius)
      : cutter_(cutter), flute_(flute), x_(x), core_(blank_radius) {
    core_ = leastRadius(flute, x, blank_radius);
    const double depth = blank_radius - core_;
    // The floor is a point, in the middle of the arc removed just above it.
    for (double above = kNearFloor; empty_ && above < depth; above *= 4) {
      const auto arc = cutter.arc(flute, x, core_ + above);
      empty_ = !arc;
      if (arc) floor_ = *arc;
    }
    if (!empty_) return;
    const double a = angleNearest();
    core_ = blank_radius;
    floor_ = {a, a};
  }

  bool empty() const { return empty_; }
  double core() const { return core_; }
  double floor() const { return (floor_.low + floor_.high) / 2; }

  const Arc& at(double r) {
    const auto [place, is_new] = arcs_.try_emplace(r, floor_);
    if (is_new) place->second = cutter_.arc(flute_, x_, r).value_or(floor_);
    return place->second;
  }

 private:
  /// The angle of the wheel where it passes the section, or is nearest to it.
  double angleNearest() const {
    double nearest = std::numeric_limits<double>::max(), angle = 0;
    for (const WheelSweep& sweep : flute_) {
      const GrindStroke& s = sweep.stroke();
      const double axis_x = std::clamp(x_, std::min(s.from, s.to), std::max(s.from, s.to));
      if (std::abs(axis_x - x_) >= nearest) continue;
      nearest = std::abs(axis_x - x_);
      angle = sweep.a(axis_x);
    }
    return angle;
  }

  const GroundCutter& cutter_;
  const Flute& flute_;
  double x_;
  double core_;
  bool empty_ = true;
  Arc floor_;
  std::map<double, Arc> arcs_;
};

/// Makes the outline of one section.
class Outliner {
 public:
  Outliner(const GroundCutter& cutter, double x, double blank_radius, const OutlineGrid& grid)
      : cutter_(cutter), x_(x), blank_(blank_radius), grid_(grid), points_(grid.size()) {
    for (const Flute& flute : cutter.flutes()) walls_.emplace_back(cutter, flute, x, blank_radius);
    for (std::size_t i = 0; i < grid.teeth; ++i) {
      if (!walls(i).empty()) cut_.push_back(i);
      if (walls(i).core() >= kMinCore) continue;
      throw std::invalid_argument(
          format("core radius = %g m at x = %g m; allowed: from %g m", walls(i).core(), x, kMinCore));
    }
  }

  std::vector<PolarPoint> outline() {
    leaveOutSwallowed();
    if (cut_.empty()) {
      fillLands(0, polar(blank_, floor(0)), grid_.teeth, polar(blank_, floor(grid_.teeth)));
      fillWall(true, 0, blank_);
      fillWall(false, grid_.teeth, blank_);
    }
    for (std::size_t i = 0; i < cut_.size(); ++i) fillBody(cut_[i], next(i));
    return std::move(points_);
  }

 private:
  /// Flutes are numbered on over the turns.
  FluteWalls& walls(std::size_t flute) { return walls_[cutter_.teeth()[flute % grid_.teeth].flute]; }
  double laps(std::size_t flute) const {
    const std::size_t whole = flute / grid_.teeth;
    return static_cast<double>(whole);
  }
  double angle(std::size_t flute) const {
    return cutter_.teeth()[flute % grid_.teeth].angle + units::kTurn * laps(flute);
  }
  double floor(std::size_t flute) { return angle(flute) + walls(flute).floor(); }
  double high(std::size_t flute, double r) { return angle(flute) + walls(flute).at(r).high; }
  double low(std::size_t flute, double r) { return angle(flute) + walls(flute).at(r).low; }
  std::size_t next(std::size_t i) const { return i + 1 < cut_.size() ? cut_[i + 1] : cut_[0] + grid_.teeth; }

  /// The radius of ring `ring` of a wall that ends at the radius `top`.
  double radius(std::size_t flute, std::size_t ring, double top) {
    if (ring == grid_.rings) return top;
    const double core = walls(flute).core();
    return core + (top - core) * squared(static_cast<double>(ring) / static_cast<double>(grid_.rings));
  }

  std::size_t shallower(std::size_t a, std::size_t b) { return walls(a).core() > walls(b).core() ? a : b; }

  /// The angle left between a flute and the next on the circle of radius r.
  double gap(std::size_t from, std::size_t to, double r) { return low(to, r) - high(from, r); }

  void leaveOutSwallowed() {
    for (std::size_t i = 0; i < cut_.size() && cut_.size() > 1;) {
      const std::size_t from = cut_[i], to = next(i);
      if (gap(from, to, walls(shallower(from, to)).core()) > 0) {
        ++i;
        continue;
      }
      cut_.erase(std::find(cut_.begin(), cut_.end(), shallower(from, to) % grid_.teeth));
      i = 0;
    }
  }

  /// The radius up to which material is left between a flute and the next.
  double top(std::size_t from, std::size_t to) {
    const std::size_t shallow = shallower(from, to);
    double inside = walls(shallow).core();
    for (std::size_t ring = 1; ring <= grid_.rings; ++ring) {
      const double r = radius(shallow, ring, blank_);
      if (gap(from, to, r) > 0) {
        inside = r;
        continue;
      }
      const auto f = [&](double at) { return gap(from, to, at); };
      std::uintmax_t steps = kMaxMeetingSteps;
      const auto meet =
          boost::math::tools::toms748_solve(f, inside, r, boost::math::tools::eps_tolerance<double>(45), steps);
      return meet.first;
    }
    return blank_;
  }

  /// Fills the body between a flute and the next one that removes something.
  void fillBody(std::size_t from, std::size_t to) {
    const double r = top(from, to);
    if (const auto heel = r < blank_ ? std::nullopt : heelOf(from, to)) return fillRelieved(from, to, *heel);
    PolarPoint first = polar(r, high(from, r)), last = polar(r, low(to, r));
    if (r < blank_) first = last = between(first, last, 0.5);
    fillWall(true, from, r);
    fillWall(false, to, r);
    fillLands(from, first, to, last);
  }

  bool rightHand() const { return cutter_.direction() == CutDirection::kRightHand; }

  /// The angle at which a body's reliefs meet a circle, nearest to the edge.
  struct Relieved {
    double angle;
    const Relief* relief;  ///< relief that forms the surface there
  };

  std::optional<Relieved> relieved(std::size_t from, std::size_t to, double r) const {
    const std::size_t flute = rightHand() ? from : to;
    std::optional<Relieved> nearest;
    for (const Relief& relief : cutter_.reliefs(flute % grid_.teeth)) {
      const auto wall = outermostWall(relief, x_, r, !rightHand());
      if (!wall) continue;
      const double at = angle(flute) + wall->angle;
      if (!nearest || (rightHand() ? at < nearest->angle : at > nearest->angle)) nearest = {at, &relief};
    }
    return nearest;
  }

  /// The radius at which the relief at a body's edge ends.
  /// @param heel radius at which the land ends.
  double primaryEnd(std::size_t from, std::size_t to, double heel) const {
    double outer = blank_ * kBelowEdgeCircle, inner = heel;
    const auto first = relieved(from, to, outer);
    const auto is_first = [&](double r) {
      const auto at = relieved(from, to, r);
      return at && at->relief == first->relief;
    };
    if (grid_.columns == grid_.primary() || is_first(heel)) return heel;
    for (int i = 0; i < kHeelHalvings; ++i) {
      const double middle = (outer + inner) / 2;
      (is_first(middle) ? outer : inner) = middle;
    }
    return outer;
  }

  /// The radius at which the relieved land, from the edge inward, first meets the flute behind it, at the latest at its
  /// floor; nothing if the body is not relieved.
  std::optional<double> heelOf(std::size_t from, std::size_t to) {
    const double top = blank_ * kBelowEdgeCircle, lowest = std::max(walls(from).core(), walls(to).core());
    if (!relieved(from, to, top)) return std::nullopt;
    const auto gap = [&](double r) {
      const auto at = relieved(from, to, r);
      if (!at) return blank_;
      return rightHand() ? at->angle - low(to, r) : high(from, r) - at->angle;
    };
    double outer = top, inner = top;
    for (int i = 1; i <= kHeelRings && gap(inner) < 0; ++i) {
      outer = inner;
      inner = top + (lowest - top) * i / kHeelRings;
    }
    if (inner == top) return std::nullopt;
    for (int i = 0; i < kHeelHalvings; ++i) {
      const double middle = (outer + inner) / 2;
      (gap(middle) < 0 ? outer : inner) = middle;
    }
    return outer;
  }

  /// Fills a body whose land falls from its edge to its heel.
  void fillRelieved(std::size_t from, std::size_t to, double heel) {
    fillWall(true, from, rightHand() ? blank_ : heel);
    fillWall(false, to, rightHand() ? heel : blank_);
    const double primary_end = primaryEnd(from, to, heel);
    const double edge = rightHand() ? high(from, blank_) : low(to, blank_);
    const double back = rightHand() ? low(to, heel) : high(from, heel);
    std::vector<PolarPoint> land;
    for (std::size_t column = 0; column <= grid_.columns; ++column) {
      const double r = landRadius(rightHand() ? column : grid_.columns - column, primary_end, heel);
      const auto at = relieved(from, to, r);
      const double angle = r == blank_ || !at ? edge : r == heel ? back : at->angle;
      land.push_back(polar(r, std::clamp(angle, std::min(edge, back), std::max(edge, back))));
    }
    // The flutes in between remove nothing, and shrink to the land's end.
    for (std::size_t flute = from; flute < to; ++flute) {
      for (std::size_t column = 0; column <= grid_.columns; ++column) {
        set(flute, grid_.land(flute, column), flute == from ? land[column] : land.back());
      }
      if (flute + 1 == to) break;
      for (std::size_t ring = 1; ring < grid_.rings; ++ring) set(flute, grid_.lowOfNext(flute, ring), land.back());
      for (std::size_t ring = 0; ring < grid_.rings; ++ring) set(flute + 1, grid_.high(flute + 1, ring), land.back());
    }
  }

  /// @param column column from the edge.
  double landRadius(std::size_t column, double primary_end, double heel) const {
    const std::size_t primary = grid_.primary();
    const auto between = [&](double from, double to, std::size_t part, std::size_t of) {
      return part == of ? to : from + (to - from) * static_cast<double>(part) / static_cast<double>(of);
    };
    if (column <= primary) return between(blank_, primary_end, column, primary);
    return between(primary_end, heel, column - primary, grid_.columns - primary);
  }

  void fillWall(bool of_high, std::size_t flute, double top) {
    for (std::size_t ring = 0; ring < grid_.rings; ++ring) {
      const double r = radius(flute, ring, top);
      const double a = ring == 0 || walls(flute).empty() ? floor(flute) : of_high ? high(flute, r) : low(flute, r);
      if (of_high) {
        set(flute, grid_.high(flute, ring), polar(r, a));
      } else if (ring > 0) {
        set(flute - 1, grid_.lowOfNext(flute - 1, ring), polar(r, a));
      }
    }
  }

  /// Fills the land between the walls of two flutes; the flutes in between remove nothing, and shrink to a point of it.
  void fillLands(std::size_t from, const PolarPoint& first, std::size_t to, const PolarPoint& last) {
    PolarPoint begin = first;
    for (std::size_t flute = from; flute < to; ++flute) {
      const bool ends = flute + 1 == to;
      PolarPoint end = ends ? last : polar(first.radius, floor(flute + 1));
      end.turns = std::clamp(end.turns, begin.turns, last.turns);
      for (std::size_t column = 0; column <= grid_.columns; ++column) {
        const double part = static_cast<double>(column) / static_cast<double>(grid_.columns);
        set(flute, grid_.land(flute, column), between(begin, end, part));
      }
      for (std::size_t ring = 1; ring < grid_.rings && !ends; ++ring) {
        set(flute, grid_.lowOfNext(flute, ring), end);
      }
      for (std::size_t ring = 0; ring < grid_.rings && !ends; ++ring) {
        set(flute + 1, grid_.high(flute + 1, ring), end);
      }
      begin = end;
    }
  }

  void set(std::size_t flute, std::size_t point, PolarPoint value) {
    value.turns -= laps(flute);
    points_[point] = value;
  }

  const GroundCutter& cutter_;
  double x_;
  double blank_;
  OutlineGrid grid_;
  std::vector<FluteWalls> walls_;
  std::vector<std::size_t> cut_;  ///< the flutes that remove something, ascending
  std::vector<PolarPoint> points_;
};

}  // namespace

PolarPoint between(const PolarPoint& from, const PolarPoint& to, double part, double bend) noexcept {
  return {from.radius + part * (to.radius - from.radius),
          from.turns + roundedTurns(part * (to.turns - from.turns) + bend)};
}

SurfaceKind OutlineGrid::kind(std::size_t point, CutDirection direction) const noexcept {
  const std::size_t within = point % perTooth();
  if (within >= rings && within < rings + columns) {
    const std::size_t column = within - rings;
    const std::size_t from_edge = direction == CutDirection::kRightHand ? column : columns - 1 - column;
    return relieved && from_edge < primary() ? SurfaceKind::kPrimary : SurfaceKind::kLand;
  }
  const bool high_wall = within < rings;
  return high_wall == (direction == CutDirection::kRightHand) ? SurfaceKind::kRakeFace : SurfaceKind::kFluteBack;
}

std::size_t OutlineGrid::tooth(std::size_t point, CutDirection direction) const noexcept {
  const std::size_t body = point / perTooth() % teeth;
  return direction == CutDirection::kRightHand ? body : (body + 1) % teeth;
}

std::vector<PolarPoint> sectionOutline(const GroundCutter& cutter, double x, double blank_radius,
                                       const OutlineGrid& grid) {
  if (grid.teeth == 0 || grid.teeth != cutter.teeth().size() || grid.rings < 2 || grid.columns < 1) {
    throw std::invalid_argument(format(
        "grid of %zu teeth, %zu rings, %zu columns; allowed: the cutter's %zu teeth, from 2 rings, from 1 column",
        grid.teeth, grid.rings, grid.columns, cutter.teeth().size()));
  }
  return Outliner(cutter, x, blank_radius, grid).outline();
}

}  // namespace grinder
