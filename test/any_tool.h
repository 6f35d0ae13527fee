#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/conical_cutter.h"

namespace grinder::test_support {

/// Asks for no edge, core and chord in particular.
inline void askForRakeAlone(CutterGeometry& g) {
  g.chordal_rake_tolerance = g.spiral_tolerance = units::kPi;
  g.core_diameter = g.core_diameter_end = 1e-6;
  g.core_tolerance = 0.1;
}

}  // namespace grinder::test_support
