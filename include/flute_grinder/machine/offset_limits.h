#pragma once

#include "flute_grinder/motion/axis_limits.h"
#include "flute_grinder/motion/work_offsets.h"

#include <string>

namespace grinder {

/// Which work offsets an axis can have.
struct OffsetLimits {
  Axes min = Axes::Zero();     ///< [m], A [rad]
  Axes max = Axes::Zero();     ///< [m], A [rad]
  Axes change = Axes::Zero();  ///< by which one that was set may change without a confirmation [m], A [rad]
};

/// Zero points within the axes' travel, since a job passes through X = 0 and Y = 0, and near Z = 0; that of A up to a
/// turn beyond, where its angle is the same. All within kMaxOffset.
/// @param change as OffsetLimits::change.
OffsetLimits offsetLimits(const AxisLimits& travel, const Axes& change);

/// Why an offset is not possible, for the operator in mm and deg; empty if it is. @param value [m], A [rad].
std::string travelRefusal(const OffsetLimits& limits, int axis, double value);

/// Why an offset must be confirmed, for the operator in mm and deg; empty if it need not be. One that was never set, or
/// is unknown, may become any.
/// @param from as it was. @param to [m], A [rad].
std::string changeRefusal(const OffsetLimits& limits, int axis, const WorkOffset& from, double to);

}  // namespace grinder
