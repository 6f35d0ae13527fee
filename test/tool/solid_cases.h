#pragma once

#include "tool/ground_case.h"

#include <cstddef>
#include <string>
#include <vector>

namespace grinder::test_support {

/// A ground cutter with the part of it that is shown.
struct SolidCase {
  std::string name;
  Case job;
  GroundCutter ground;
  double from = 0, to = 0;  ///< [m]
};

/// Flutes at angles in degrees, all alike.
inline GroundCutter groundAt(const Case& c, const std::vector<double>& angles) {
  std::vector<GroundTooth> teeth;
  for (const double angle : angles) teeth.push_back({angle * kDegree, 0});
  return {c.cutter(), {{c.sweep()}}, teeth};
}

inline Case cylinder() {
  Case c;
  c.face = c.diameter / 2 * std::sin(c.rake * kDegree);
  c.width = 2;
  c.swivel = 38;
  return c;
}

/// Cutters of every kind: cone, cylinder, back taper, both hands, unequal pitch, a flute of its own for each tooth,
/// lands ground away, flutes that run out, a single tooth.
inline std::vector<SolidCase> solidCases() {
  std::vector<SolidCase> all;
  const auto add = [&](const char* name, const Case& c, const GroundCutter& ground, double from_mm, double to_mm) {
    all.push_back({name, c, ground, from_mm * kMillimetre, to_mm * kMillimetre});
  };
  Case paper;
  paper.cone = 5;
  paper.width = 3;
  paper.swivel = 31.769;
  paper.face = 4.552;
  paper.from = -20;
  paper.to = 30;
  add("paper", paper, paper.ground(2), 0, 45);

  add("cylinder", cylinder(), cylinder().ground(4), 0, 30);

  Case taper = cylinder();
  taper.cone = -1;
  add("back taper", taper, taper.ground(3), 0, 30);

  Case left = cylinder();
  left.spiral = -30;
  left.swivel = -38;
  left.face = left.width / std::cos(left.swivel * kDegree) - left.face;
  left.cut = CutDirection::kLeftHand;
  Case shallower_left = left;
  shallower_left.spiral = -33;
  shallower_left.depth = 1.1;
  const GroundCutter unequal_left(left.cutter(), {{left.sweep()}, {shallower_left.sweep()}},
                                  {{0, 0}, {80 * kDegree, 1}, {190 * kDegree, 0}, {262 * kDegree, 1}});
  add("left hand", left, unequal_left, 0, 30);

  add("unequal pitch", cylinder(), groundAt(cylinder(), {0, 80, 190, 262}), 0, 30);

  Case gone = cylinder();
  gone.width = 6;
  add("lands gone", gone, gone.ground(4), 0, 30);

  Case out = cylinder();
  out.from = -3;
  out.to = 12;
  out.depth = 1.2;
  add("running out", out, out.ground(4), 0, 40);

  Case steeper = cylinder(), shallower = cylinder();
  steeper.spiral = 33;
  shallower.depth = 1.1;
  const GroundCutter own(cylinder().cutter(), {{cylinder().sweep()}, {steeper.sweep()}, {shallower.sweep()}},
                         {{0, 0}, {90 * kDegree, 1}, {180 * kDegree, 2}, {270 * kDegree, 0}});
  add("a flute for each tooth", cylinder(), own, 0, 20);

  add("single tooth", cylinder(), cylinder().ground(1), 0, 30);
  return all;
}

}  // namespace grinder::test_support
