#pragma once

#include "flute_grinder/curve/conical_cutter.h"

namespace grinder {

/// What is asked of a conical end mill, as given in a job file or goal, unchecked. `rake_angle` is the radial rake.
struct CutterGeometry : Cone {
  double rake_tolerance = 0;     ///< maximum allowed difference of the ground rake from the asked one [rad]
  double shank_diameter = 0;     ///< [m]
  double core_diameter = 0;      ///< asked diameter of the core at the small end [m]
  double neck_length = 0;        ///< length from the flute's end to the shank; 0: unknown [m]
  double core_diameter_end = 0;  ///< asked diameter of the core at the flute's end [m]
  double core_tolerance = 0;     ///< maximum allowed difference of the ground core's diameter from the asked one [m]
  double spiral_tolerance = 0;   ///< maximum error of the edge's spiral angle [rad]
  double chordal_rake_tolerance = 0;  ///< maximum error of the ground chordal rake against the asked rake [rad]
  double chordal_rake_depth = 0;      ///< depth of the chord's end below the edge; 0: a tenth of the flute's depth [m]
  double clearance = 0;               ///< asked radial clearance of the primary relief at the edge; 0: no reliefs [rad]
  double clearance_tolerance = 0;     ///< maximum allowed difference of the ground clearances from the asked ones [rad]
  double land = 0;                    ///< asked width of the primary relief at the small end; 0: up to the heel [m]
  double second_clearance = 0;        ///< asked clearance of the secondary relief at its start; 0: none [rad]
};

}  // namespace grinder
