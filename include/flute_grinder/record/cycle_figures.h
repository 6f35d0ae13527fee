#pragma once

#include <cmath>

namespace grinder {

/// Whether a control cycle counts as late: after more than 1.5 periods. @param period, nominal [s].
inline bool isLate(double period, double nominal) { return !(period <= 1.5 * nominal); }

/// Keeps the larger value; NaN is kept.
inline void updateMax(double& max, double value) {
  if (!(value <= max) && !std::isnan(max)) max = value;
}

}  // namespace grinder
