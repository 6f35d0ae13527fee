#pragma once

namespace grinder {

/// First line of a CSV file of `grind table`, as in the paper's Table 1.
inline constexpr char kTableColumns[] = "point,x_mm,a_rad,a_theory_rad,error_rad";
/// Of `grind plan`.
inline constexpr char kSetpointColumns[] =
    "cycle,time_s,move,tooth,pass,step,x_mm,y_mm,z_mm,a_rad,error_rad,feed_mm_min";
/// What `grind run` appends: the position that the drive read one cycle before.
inline constexpr char kActualColumns[] = ",actual_x_mm,actual_y_mm,actual_z_mm,actual_a_rad";

}  // namespace grinder
