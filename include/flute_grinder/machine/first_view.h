#pragma once

namespace grinder {

/// The straight wheel and the round blank that rviz shows until there is a job.
struct FirstView {
  double wheel_diameter = 0;  ///< [m]
  double wheel_width = 0;     ///< [m]
  double blank_diameter = 0;  ///< [m]
  double blank_length = 0;    ///< length from the end face into the collet [m]
};

}  // namespace grinder
