#include "flute_grinder/curve/log_curve.h"

#include <cmath>

namespace grinder {

double LogCurve::log1pRatio(double z) noexcept { return z == 0 ? 1 : std::log1p(z) / z; }

}  // namespace grinder
