#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/enum_table.h"

#include <cstdint>

namespace grinder {

/// An automatic measurement by the probe, after it was jogged near its target.
enum class ProbingCycle : std::uint8_t { kEndFace, kDiameter, kTooth };

struct ProbingCycleRow : EnumRow<ProbingCycle> {
  int axis = kX;               ///< axis that searches, and whose work offset is set
  bool always_for_job = true;  ///< a job is always needed; otherwise only to set an offset, with a known diameter
  double within = 0;           ///< maximum travel to a touch, unless the request has another [m], A [rad]
  const char* help = "";
};

/// Each cycle with its name in messages; on the command line with a hyphen.
inline constexpr ProbingCycleRow kProbingCycles[]{
    {{ProbingCycle::kEndFace, "end_face"}, kX, true, 0.005, "X: print the stick-out and set the work offset"},
    {{ProbingCycle::kDiameter, "diameter"},
     kY,
     false,
     0.005,
     "Y, on four sides: print diameter and run-out of a cylinder"},
    {{ProbingCycle::kTooth, "tooth"},
     kA,
     true,
     1.5707963267948966,
     "A: touch the first tooth's rake face and set the work offset"},
};
constexpr auto& rowsOf(ProbingCycle) noexcept { return kProbingCycles; }

}  // namespace grinder
