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
  double end_clearance = 0;           ///< asked axial clearance of the end teeth at their edges; 0: no end teeth [rad]
  double end_second_clearance = 0;    ///< asked axial clearance of their secondary flanks; 0: none [rad]
  double end_land = 0;                ///< asked width of their primary flanks; 0: up to the heel [m]
  double end_dish = 0;                ///< angle by which the end is hollow toward the axis [rad]
  double end_rake = 0;                ///< asked axial rake of the gashes [rad]
  double end_clearance_tolerance = 0;  ///< maximum allowed difference of the ground clearances of the end [rad]
  double end_rake_tolerance = 0;       ///< maximum allowed difference of the ground rake of the gashes [rad]
  double end_uncut_diameter = 0;       ///< diameter in which edges of end teeth may be missing [m]
  int end_center_teeth = 0;      ///< number of end teeth whose edges go to the axis, see GrindJob::isShort(); 0: none
  double end_short_from = 0;     ///< radius outside which the edges of the other end teeth are whole [m]
  double chamfer_width = 0;      ///< asked width of the chamfer, seen along the axis; 0: none [m]
  double chamfer_angle = 0;      ///< asked angle between chamfer and axis [rad]
  double chamfer_clearance = 0;  ///< asked clearance of the chamfer, normal to its edge [rad]
};

}  // namespace grinder
