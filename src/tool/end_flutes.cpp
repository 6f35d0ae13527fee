#include "tool/end_flutes.h"

#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr int kFluteRings = 40;
constexpr double kWithin = 1e-6;  ///< part of the radius by which the outermost circle is within the blank

/// Where a value that is linear over X is at least another, as a range of X.
Range whereAtLeast(double at_end, double at_length, double length, double at_least) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (at_end == at_length) return at_end >= at_least ? Range{-infinity, infinity} : Range{infinity, -infinity};
  const double x = (at_least - at_end) / (at_length - at_end) * length;
  return at_length > at_end ? Range{x, infinity} : Range{-infinity, x};
}

}  // namespace

EndFlutes::EndFlutes(const GroundCutter& cutter)
    : radius_(cutter.cutter().radius(0)),
      length_(std::min(radius_, cutter.cutter().cone().flute_length)),
      teeth_(cutter.teeth()) {
  for (const Flute& flute : cutter.flutes()) {
    std::vector<Ring>& rings = flutes_.emplace_back(kFluteRings + 1);
    for (int i = 1; i <= kFluteRings; ++i) {
      const double r = radius_ * std::min(1 - kWithin, static_cast<double>(i) / kFluteRings);
      const auto at_end = cutter.arc(flute, 0, r), behind = cutter.arc(flute, length_, r);
      if (at_end && behind) rings[static_cast<std::size_t>(i)] = {*at_end, *behind};
    }
  }
}

void EndFlutes::addRemoved(std::size_t tooth, double r, double angle, std::vector<Range>& ranges) const {
  const std::vector<Ring>& rings = flutes_[teeth_[tooth].flute];
  const double place = std::min(r / radius_, 1.0) * kFluteRings;
  const auto inner = std::min(static_cast<std::size_t>(place), std::size_t{kFluteRings - 1});
  const Ring &a = rings[inner], &b = rings[inner + 1];
  if (!a || !b) return;
  const double part = place - static_cast<double>(inner);
  const auto between = [&](double Arc::*end, std::size_t section) {
    return (1 - part) * ((*a)[section].*end) + part * ((*b)[section].*end);
  };
  const double low[] = {between(&Arc::low, 0), between(&Arc::low, 1)};
  const double high[] = {between(&Arc::high, 0), between(&Arc::high, 1)};
  const double from_tooth = std::remainder(angle - teeth_[tooth].angle, units::kTurn);
  for (const int turns : {-1, 0, 1}) {
    const double wanted = from_tooth + turns * units::kTurn;
    const Range above = whereAtLeast(-low[0], -low[1], length_, -wanted);
    const Range below = whereAtLeast(high[0], high[1], length_, wanted);
    const Range both{std::max(above.from, below.from), std::min(above.to, below.to)};
    if (both.from < both.to) ranges.push_back(both);
  }
}

}  // namespace grinder
