#pragma once

#include "flute_grinder/core/axes.h"

#include <array>
#include <cmath>
#include <string>

namespace flute_grinder {

/// Largest size of a work offset; farther than any axis goes, and with a rounding far below any encoder's [m], A [rad].
constexpr double kLargestOffset = 1000;

namespace core {

/// Where the work stands on an axis, and who said so.
struct WorkOffset {
  double value = 0;    ///< machine position - work position; NaN if it is unknown, see OffsetStore [m], A [rad]
  std::string set_by;  ///< for people; empty if it was never set
  double set_at = 0;   ///< since the epoch; 0 if it was never set [s]
};

/// The work offset of every axis. The coordinates of a job are the work's; those of limits, park position, homing and
/// drive are the machine's.
struct WorkOffsets {
  std::array<WorkOffset, kAxisCount> axes;

  /// [m], A [rad]
  Axes values() const noexcept {
    Axes values;
    for (int axis = 0; axis < kAxisCount; ++axis) values[axis] = axes[static_cast<std::size_t>(axis)].value;
    return values;
  }
};

}  // namespace core

}  // namespace flute_grinder
