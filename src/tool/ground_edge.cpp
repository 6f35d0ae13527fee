#include "flute_grinder/tool/ground_edge.h"

#include <algorithm>

namespace grinder {

namespace {

using Place = GroundEdge::Place;

/// Interpolates linearly by one member between the places next to its value.
Place between(const std::vector<Place>& places, double Place::*member, double value) noexcept {
  const auto is_less = [member](const Place& place, double v) { return place.*member < v; };
  const auto after = std::lower_bound(places.begin(), places.end(), value, is_less);
  if (after == places.begin() || after == places.end()) {
    Place end = after == places.begin() ? places.front() : places.back();
    const double beyond = value - end.*member;
    end.x += beyond;
    end.wheel_x += beyond;
    return end;
  }
  const Place& before = *(after - 1);
  const double share = (value - before.*member) / (*after.*member - before.*member);
  const auto linear = [share](double from, double to) { return from + share * (to - from); };
  return {linear(before.x, after->x), linear(before.wheel_x, after->wheel_x), linear(before.turn, after->turn)};
}

}  // namespace

Place GroundEdge::at(double x) const noexcept { return between(places_, &Place::x, x); }

Place GroundEdge::formedAt(double wheel_x) const noexcept { return between(places_, &Place::wheel_x, wheel_x); }

}  // namespace grinder
