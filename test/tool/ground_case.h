#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/ground_cutter.h"

namespace grinder::test_support {

using units::kDegree;
using units::kMillimetre;

/// A cutter, a wheel and a set-up, in the shop's units.
struct Case {
  double diameter = 10, cone = 0, spiral = 30, rake = 8, depth = 1.6;
  double wheel = 100, width = 6, swivel = 30, face = 0;  ///< height of the upper face above the axis
  double from = -1000, to = 1000;
  double a = 0;
  CutDirection cut = CutDirection::kRightHand;

  ConicalCutter cutter() const {
    Cone g;
    g.end_diameter = diameter * kMillimetre;
    g.cone_angle = cone * kDegree;
    g.spiral_angle = spiral * kDegree;
    g.rake_angle = rake * kDegree;
    g.flute_length = kMillimetre;
    g.cut = cut;
    return ConicalCutter(g);
  }
  WheelProfile profile() const { return WheelProfile::straight(wheel * kMillimetre, width * kMillimetre); }
  WheelSetup setup() const { return {swivel * kDegree, (face - width / 2 / std::cos(swivel * kDegree)) * kMillimetre}; }
  GrindStroke stroke() const { return {from * kMillimetre, to * kMillimetre, -depth * kMillimetre, 0, a}; }
  WheelSweep sweep() const { return sweep(profile()); }
  WheelSweep sweep(const WheelProfile& p) const { return {cutter(), p, wheel / 2 * kMillimetre, setup(), stroke()}; }
  GroundCutter ground(int teeth = 1) const {
    std::vector<GroundTooth> all;
    for (int i = 0; i < teeth; ++i) all.push_back({2 * units::kPi * i / teeth, 0});
    return {cutter(), {{sweep()}}, all};
  }
};

}  // namespace grinder::test_support
