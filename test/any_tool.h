#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/cutter_geometry.h"

namespace grinder::test_support {

/// Asks for no edge, core and chord in particular.
inline void askForRakeAlone(CutterGeometry& g) {
  g.chordal_rake_tolerance = g.spiral_tolerance = units::kPi;
  g.core_diameter = g.core_diameter_end = 1e-6;
  g.core_tolerance = 0.1;
}

/// A cone of which the rake is asked alone, to half a degree.
inline CutterGeometry anyToolOf(const Cone& cone, double shank_diameter) {
  CutterGeometry g{cone};
  g.rake_tolerance = 0.5 * units::kDegree;
  g.shank_diameter = shank_diameter;
  askForRakeAlone(g);
  return g;
}

}  // namespace grinder::test_support
