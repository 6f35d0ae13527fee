#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/machine/need.h"

#include <cmath>
#include <limits>
#include <optional>

namespace grinder {

/// Maximum difference between a job's swivel and the actual swivel [rad].
constexpr double kSwivelTolerance = 0.05 * units::kDegree;
/// Maximum angle that can be confirmed, to either side [rad].
constexpr double kMaxSwivel = units::kPi / 2;

/// The angle of the wheel's swivel. It is set by hand: an operator confirms its angle, unless the drive measures it.
struct Swivel {
  double angle = std::numeric_limits<double>::quiet_NaN();  ///< NaN if it is unknown [rad]
  bool measured = false;                                    ///< whether the drive measures the angle

  /// Whether the swivel is at a job's angle; false for an unknown angle. Real-time safe.
  /// @param asked the job's angle [rad].
  bool isAt(double asked) const noexcept { return std::abs(angle - asked) <= kSwivelTolerance; }
};

/// Why a job cannot be ground with the present swivel, and the remedy.
/// @param asked the job's angle [rad].
Reason reasonOf(const Swivel& swivel, double asked);

/// What must be said, or done, before a job starts with the present swivel; nothing if it is at the job's angle.
/// @param asked the job's angle [rad].
std::optional<Need> needOf(const Swivel& swivel, double asked);

}  // namespace grinder
