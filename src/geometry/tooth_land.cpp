#include "geometry/tooth_land.h"

#include "flute_grinder/curve/units.h"

#include <algorithm>

namespace grinder {

ToothLand::ToothLand(const GroundCutter& cutter, const GroundSection& section, std::size_t number)
    : x_(section.x), right_(cutter.direction() == CutDirection::kRightHand) {
  const std::vector<GroundTooth>& teeth = cutter.teeth();
  edge_ = *section.teeth[number].edge - teeth[number].angle;
  const GroundCutter::NextTooth next = cutter.next(number);
  pitch_ = next.pitch;
  next_flute_ = &cutter.flutes()[teeth[next.tooth].flute];
}

std::optional<ToothLand::Surface> ToothLand::surface(const WheelSweep& relief, double r) const {
  const auto wall = relief.wall(x_, r, !right_);
  if (!wall) return std::nullopt;
  return Surface{behind(wall->angle), right_ ? wall->slope : -wall->slope};
}

double ToothLand::farEnd(const WheelSweep& relief, double r) const {
  const auto wall = relief.wall(x_, r, right_);
  return wall ? behind(wall->angle) : -units::kTurn;
}

std::optional<double> ToothLand::wallOf(const Flute& flute, double r, bool high) const {
  std::optional<double> farthest;
  for (const WheelSweep& sweep : flute) {
    const auto wall = sweep.wall(x_, r, high);
    if (!wall) continue;
    farthest = !farthest ? wall->angle : high ? std::max(*farthest, wall->angle) : std::min(*farthest, wall->angle);
  }
  if (farthest) farthest = behind(*farthest);
  return farthest;
}

}  // namespace grinder
