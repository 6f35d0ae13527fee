#pragma once

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/reason.h"

#include <cmath>
#include <limits>

namespace grinder {

/// Maximum difference between a job's swivel and the swivel as it is [rad].
constexpr double kSwivelTolerance = 0.05 * units::kDegree;
/// Maximum angle that can be confirmed, to either side [rad].
constexpr double kMaxSwivel = units::kPi / 2;

/// Where the wheel's swivel stands. It is set by hand: an operator confirms its angle, unless the drive measures it.
struct Swivel {
  double angle = std::numeric_limits<double>::quiet_NaN();  ///< NaN if it is unknown [rad]
  bool measured = false;                                    ///< by the drive

  /// Whether it stands where a job needs it; never true of an unknown angle. Real-time safe.
  /// @param asked the job's angle [rad].
  bool isAt(double asked) const noexcept { return std::abs(angle - asked) <= kSwivelTolerance; }
};

/// Why a job cannot be ground with the swivel as it is, and what to do about it.
/// @param asked the job's angle [rad].
Reason reasonOf(const Swivel& swivel, double asked);

}  // namespace grinder
