#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/odd_even_interpolator.h"

#include <ostream>

namespace grinder::test_support {

/// The paper's cutter: D1 10 mm, S 30 deg, C 5 deg, r 8 deg, 30 mm.
inline Cone paperCone() { return {10e-3, 5 * units::kDegree, 30 * units::kDegree, 8 * units::kDegree, 30e-3}; }

}  // namespace grinder::test_support

namespace grinder {

inline std::ostream& operator<<(std::ostream& out, const Cone& g) {
  return out << "D1 " << g.end_diameter / units::kMillimetre << " mm, C " << g.cone_angle / units::kDegree << " deg, S "
             << g.spiral_angle / units::kDegree << " deg, r " << g.rake_angle / units::kDegree << " deg, L "
             << g.flute_length / units::kMillimetre << " mm";
}

inline std::ostream& operator<<(std::ostream& out, EvenStepRule rule) { return out << toString(rule); }

}  // namespace grinder
