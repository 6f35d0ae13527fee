#include "flute_grinder/tool/removed_volume.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

#include <cmath>
#include <stdexcept>

namespace grinder {

RemovedVolume wedge(double from, double to) {
  if (!(to > from && to - from < units::kPi)) {
    throw std::invalid_argument(format("wedge from %g to %g rad; allowed: rising, by less than half a turn", from, to));
  }
  return {{{{0, -std::sin(from), std::cos(from)}, 0}, {{0, std::sin(to), -std::cos(to)}, 0}}, {}, SurfaceKind::kCut, 0};
}

}  // namespace grinder
