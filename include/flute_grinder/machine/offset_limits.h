#pragma once

#include "flute_grinder/machine/need.h"
#include "flute_grinder/motion/axis_limits.h"
#include "flute_grinder/motion/work_offsets.h"

#include <optional>
#include <string>

namespace grinder {

/// The range of an axis's work offset.
struct OffsetLimits {
  Axes min = Axes::Zero();     ///< [m], A [rad]
  Axes max = Axes::Zero();     ///< [m], A [rad]
  Axes change = Axes::Zero();  ///< maximum change of a set offset without confirmation [m], A [rad]
};

/// Zero points within the axes' travel, since a job passes through X = 0 and Y = 0, and near Z = 0; for A, up to a turn
/// beyond the travel, where the angle is the same. All within kMaxOffset.
/// @param change see OffsetLimits::change.
OffsetLimits offsetLimits(const AxisLimits& travel, const Axes& change);

/// Why an offset is not possible, for the operator in mm and deg; empty if it is possible.
/// @param value the offset [m], A [rad].
std::string travelRefusal(const OffsetLimits& limits, int axis, double value);

/// What must be said before any offset changes by more than OffsetLimits::change, with a figure for each that does. An
/// offset that was never set, or is unknown, may be set to any value.
/// @param from the present offsets.
/// @param to the new values.
std::optional<Need> needOfChange(const OffsetLimits& limits, const WorkOffsets& from, const OffsetValues& to);

}  // namespace grinder
