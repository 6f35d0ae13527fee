#include "tool/ground_end.h"

#include "flute_grinder/base/units.h"
#include "tool/change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grinder {

namespace {

constexpr double kStep = 0.02;       ///< step of the search for an edge and for the end of a land, per radius
constexpr double kNearAxis = 0.1;    ///< greatest step inward along an edge, per distance from the axis
constexpr double kFarthest = 0.6;    ///< how far behind the radius an edge is searched, per radius
constexpr double kNearby = 1e-5;     ///< distance between the rays of a slope, per radius
constexpr double kRakeDepth = 0.02;  ///< depth below the edge at which the rake face is found, per radius
/// Width of what may be left of the blank's end in front of a primary flank, per radius: a blank without stock is not
/// quite reached where an axis is off by the rounding of its encoder.
constexpr double kBlunt = 2e-3;
constexpr int kHalvings = 13;                     ///< of a step, to far less than a blunt edge or a fin
constexpr int kFacesInStep = 8;                   ///< most faces that a step along a heel goes over
constexpr double kHeelStep = 3 * units::kDegree;  ///< greatest step along a heel
constexpr double kInnermost = 1e-3;               ///< least radius at which an edge is looked for, per radius
constexpr int kCoreRounds = 4;   ///< number of rounds of the search for the place where a gash is deepest in the core
constexpr int kCorePlaces = 30;  ///< number of places to either side in a round

bool holds(const std::vector<Range>& ranges, double x) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [x](const Range& range) { return x >= range.from && x <= range.to; });
}

bool isOf(const EndCut* cut, std::size_t tooth, OperationKind kind) {
  return cut != nullptr && cut->tooth == tooth && cut->kind == kind;
}

}  // namespace

GroundEnd::GroundEnd(double radius, CutDirection cut, std::vector<double> tooth_angles, std::vector<EndCut> cuts,
                     double blank_x, EndFlutes flutes)
    : radius_(radius),
      hand_(cut == CutDirection::kRightHand ? 1 : -1),
      tooth_angles_(std::move(tooth_angles)),
      cuts_(std::move(cuts)),
      blank_x_(blank_x),
      flutes_(std::move(flutes)) {}

GroundEnd::Ray GroundEnd::rayAt(double r, double angle) {
  return {r, angle, {r * std::cos(angle), r * std::sin(angle)}};
}

GroundEnd::Ray GroundEnd::rayAt(std::size_t tooth, double r, double behind) const {
  return rayAt(std::hypot(r, behind), tooth_angles_[tooth] + hand_ * std::atan2(behind, r));
}

GroundEnd::Surface GroundEnd::surface(std::size_t tooth, double r, double behind) const {
  return surface(rayAt(tooth, r, behind));
}

GroundEnd::Surface GroundEnd::surface(const Ray& ray) const {
  std::vector<Range> flutes;
  for (std::size_t i = 0; i < flutes_.teeth(); ++i) flutes_.addRemoved(i, ray.r, ray.angle, flutes);
  Surface left{blank_x_, nullptr, false};
  for (double before = -std::numeric_limits<double>::infinity(); left.x > before;) {
    before = left.x;
    for (const EndCut& cut : cuts_) {
      if (&cut == left.cut) continue;
      const std::optional<double> to = cut.sweep.removedTo(ray.at, left.x);
      if (to && *to > left.x) left = {*to, &cut, false};
    }
    for (const Range& range : flutes) {
      if (range.from <= left.x && range.to > left.x) left = {range.to, nullptr, true};
    }
  }
  return left;
}

bool GroundEnd::isRemoved(std::size_t tooth, double r, double behind, double x, By by) const {
  const Ray ray = rayAt(tooth, r, behind);
  for (const EndCut& cut : cuts_) {
    if ((by == By::kAny || isOf(&cut, tooth, OperationKind::kGash)) && cut.sweep.removes(ray.at, x)) return true;
  }
  std::vector<Range> flutes;
  for (std::size_t i = 0; i < flutes_.teeth() && by != By::kOwnGash; ++i) {
    if (by == By::kAny || i == tooth) flutes_.addRemoved(i, ray.r, ray.angle, flutes);
  }
  return holds(flutes, x);
}

bool GroundEnd::isRemovedOnEnd(std::size_t tooth, double r, double turn, double x) const {
  const Ray ray = rayAt(r, tooth_angles_[tooth] + turn);
  return std::any_of(cuts_.begin(), cuts_.end(), [&](const EndCut& cut) { return cut.sweep.removes(ray.at, x); });
}

bool GroundEnd::isFlank(std::size_t tooth, OperationKind kind, double r, double behind) const {
  return isOf(surface(tooth, r, behind).cut, tooth, kind);
}

std::optional<double> GroundEnd::edge(std::size_t tooth, OperationKind kind, double r, int halvings) const {
  const auto is_flank = [&](double behind) { return isFlank(tooth, kind, r, behind); };
  const double step = kStep * radius_;
  double before = -step;
  if (is_flank(before)) return std::nullopt;
  for (double behind = kNearby * radius_; behind < kFarthest * radius_; behind += step) {
    if (is_flank(behind)) {
      const double edge = changeBetween(before, behind, is_flank, halvings);
      const double x = surface(tooth, r, edge).x + kNearby * radius_;
      const double blunt = (kind == OperationKind::kPrimaryEnd ? kBlunt : kNearby) * radius_;
      const bool faced = isRemoved(tooth, r, edge - blunt, x, By::kOwnFace);
      return faced ? std::optional(edge) : std::nullopt;
    }
    before = behind;
  }
  return std::nullopt;
}

double GroundEnd::slope(std::size_t tooth, double r, double behind) const {
  const double step = kNearby * radius_;
  return (surface(tooth, r, behind + 2 * step).x - surface(tooth, r, behind + step).x) / step;
}

EndSection GroundEnd::edgeAt(std::size_t tooth, double r) const {
  EndSection section;
  section.r = r;
  const std::optional<double> behind = edge(tooth, OperationKind::kPrimaryEnd, r);
  if (!behind) return section;
  section.behind = *behind;
  section.edge = surface(tooth, r, *behind).x;
  return section;
}

EndSection GroundEnd::section(std::size_t tooth, double r) const {
  EndSection section = edgeAt(tooth, r);
  if (!section.edge) return section;
  measureFlanks(tooth, section);
  section.rake = rake(tooth, r, *section.edge, section.behind);
  return section;
}

void GroundEnd::measureFlanks(std::size_t tooth, EndSection& section) const {
  section.clearance = std::atan(slope(tooth, section.r, section.behind));
  const double step = kNearby * radius_, inside = section.behind + step;
  const double fall = surface(tooth, section.r - step, inside).x - surface(tooth, section.r, inside).x;
  section.dish = std::atan(fall / step);
  const auto is_other = [&](double behind) { return !isFlank(tooth, OperationKind::kPrimaryEnd, section.r, behind); };
  const double stride = kStep * radius_;
  double behind = section.behind + stride;
  while (!is_other(behind)) {
    behind += stride;
    if (behind > 2 * radius_) return;
  }
  const double end = changeBetween(behind - stride, behind, is_other);
  if (!isOf(surface(tooth, section.r, end + kNearby * radius_).cut, tooth, OperationKind::kSecondaryEnd)) return;
  section.land = end - section.behind;
  section.second_clearance = std::atan(slope(tooth, section.r, end));
}

double GroundEnd::gashedTo(std::size_t tooth, const std::function<double(double)>& core, double length) const {
  double turn = 0, reach = units::kPi, deepest = 0;
  // Searches the circle for the place where the gash is deepest, first coarsely, then ever more finely.
  for (int i = 0; i < kCoreRounds; ++i, reach *= 2.0 / kCorePlaces) {
    const double middle = turn;
    const auto is_gashed = [&](double x) {
      for (int place = -kCorePlaces; place <= kCorePlaces; ++place) {
        const double here = middle + reach * place / kCorePlaces;
        const Ray ray = rayAt(core(x), tooth_angles_[tooth] + here);
        const auto takes = [&](const EndCut& cut) {
          return isOf(&cut, tooth, OperationKind::kGash) && cut.sweep.removes(ray.at, x);
        };
        if (!std::any_of(cuts_.begin(), cuts_.end(), takes)) continue;
        turn = here;
        return true;
      }
      return false;
    };
    if (!is_gashed(deepest)) return deepest;
    deepest = changeBetween(length, deepest, is_gashed);
  }
  return deepest;
}

double GroundEnd::heelDrag(std::size_t tooth, const EndSection& section, double pitch) const {
  const double step = std::min(kHeelStep, kStep * radius_ / section.r), nearby = kNearby * radius_ / section.r;
  const double end = pitch - nearby;
  const auto at = [&](double turn) { return surface(rayAt(section.r, tooth_angles_[tooth] + hand_ * turn)); };
  double drag = 0, from = std::atan2(section.behind, section.r) + nearby;
  const auto look = [&](double turn, const Surface& here) {
    const bool of_next = here.cut != nullptr && here.cut->tooth != tooth && isEndFlank(here.cut->kind);
    if (!of_next || turn < pitch - step) drag = std::max(drag, *section.edge - here.x);
  };
  for (Surface before = at(from); from < end;) {
    const double to = std::min(from + step, end);
    const Surface here = at(to);
    look(to, here);
    // A fin may be narrower than a step: it begins where a face ends.
    for (int faces = 0; !before.isAlike(here) && faces < kFacesInStep; ++faces) {
      const auto is_other = [&](double turn) { return !at(turn).isAlike(before); };
      from = std::min(changeBetween(from, to, is_other, kHalvings) + nearby, to);
      before = at(from);
      look(from, before);
    }
    before = here, from = to;
  }
  return drag;
}

/// A little below the edge, the rake face is between what the gash removed and the tooth.
std::optional<double> GroundEnd::rake(std::size_t tooth, double r, double x, double behind) const {
  const double depth = kRakeDepth * radius_;
  const auto is_tooth = [&](double at) { return !isRemoved(tooth, r, at, x + depth, By::kAny); };
  if (!is_tooth(behind + depth) || is_tooth(behind - depth)) return std::nullopt;
  const double face = changeBetween(behind - depth, behind + depth, is_tooth);
  if (!isRemoved(tooth, r, face - kNearby * depth, x + depth, By::kOwnGash)) return std::nullopt;
  return std::atan((face - behind) / depth);
}

std::optional<double> GroundEnd::wholeFrom(std::size_t tooth) const {
  const auto is_whole = [&](double r) {
    return edge(tooth, OperationKind::kPrimaryEnd, r, kHalvings).has_value() ||
           edge(tooth, OperationKind::kChamfer, r).has_value();
  };
  const double corner = radius_ * (1 - kNearby), innermost = kInnermost * radius_;
  if (!is_whole(corner)) return std::nullopt;
  for (double r = corner; r > innermost;) {
    const double inner = std::max(innermost, r - std::min(kStep * radius_, kNearAxis * r));
    if (!is_whole(inner)) return changeBetween(inner, r, is_whole);
    r = inner;
  }
  return 0;
}

std::optional<ChamferFigures> GroundEnd::chamfer(std::size_t tooth) const {
  const auto at = [&](double r) { return edge(tooth, OperationKind::kChamfer, r); };
  const double corner = radius_ * (1 - kNearby), step = kStep * radius_;
  if (!at(corner)) return std::nullopt;
  double r = corner - step;
  while (r > 0 && at(r)) r -= step;
  const double inner = changeBetween(std::max(r, 0.0), r + step, [&](double r_here) { return at(r_here).has_value(); });
  // Along the edge, and across it: X of the flank over radius and distance behind it.
  const double middle = (inner + corner) / 2, nearby = kNearby * radius_;
  const double from = *at(middle), to = *at(middle + nearby);
  const double rise =
      (surface(tooth, middle + nearby, to + nearby).x - surface(tooth, middle, from + nearby).x) / nearby;
  const double per_behind = slope(tooth, middle, from);
  const double per_r = rise - per_behind * (to - from) / nearby;
  const OnTooth flank = OnTooth(-1, per_r, per_behind).normalized(), surface_here = OnTooth(-1, rise, 0).normalized();
  return ChamferFigures{radius_ - inner, units::kPi / 2 - std::atan(rise),
                        std::acos(std::clamp(flank.dot(surface_here), -1.0, 1.0))};
}

}  // namespace grinder
