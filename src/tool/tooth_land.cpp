#include "flute_grinder/tool/tooth_land.h"

#include "flute_grinder/base/units.h"

namespace grinder {

ToothLand::ToothLand(const GroundCutter& cutter, const GroundSection& section, std::size_t number)
    : x_(section.x), right_(cutter.direction() == CutDirection::kRightHand) {
  const std::vector<GroundTooth>& teeth = cutter.teeth();
  edge_ = *section.teeth[number].edge - teeth[number].angle;
  flute_ = &cutter.flutes()[teeth[number].flute];
  const GroundCutter::NextTooth next = cutter.next(number);
  pitch_ = next.pitch;
  next_flute_ = &cutter.flutes()[teeth[next.tooth].flute];
}

std::optional<ToothLand::Surface> ToothLand::surface(const Relief& relief, double r) const {
  const auto wall = outermostWall(relief, x_, r, !right_);
  if (!wall) return std::nullopt;
  return Surface{behind(wall->angle), right_ ? wall->slope : -wall->slope};
}

double ToothLand::farEnd(const Relief& relief, double r) const {
  const auto wall = outermostWall(relief, x_, r, right_);
  return wall ? behind(wall->angle) : -units::kTurn;
}

std::optional<double> ToothLand::wallOf(const Flute& flute, double r, bool high) const {
  const auto wall = outermostWall(flute, x_, r, high);
  if (!wall) return std::nullopt;
  return behind(wall->angle);
}

}  // namespace grinder
