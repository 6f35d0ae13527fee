#pragma once

#include "flute_grinder/curve/enum_table.h"
#include "flute_grinder/job/axes.h"

#include <array>
#include <string>

namespace grinder {

/// Maximum size of a work offset; farther than any axis goes, and with a rounding far below any encoder's [m], A [rad].
constexpr double kMaxOffset = 1000;

/// By what a work offset was set.
enum class OffsetMethod { kUnknown, kTouchOff, kProbe, kByHand, kComputed };

struct OffsetMethodRow : EnumRow<OffsetMethod> {
  const char* done = "set";  ///< in a sentence: "Y was ..."
};

/// With the names used in files and messages.
inline constexpr OffsetMethodRow kOffsetMethods[]{
    {{OffsetMethod::kUnknown, "unknown"}, "set"},        {{OffsetMethod::kTouchOff, "touch_off"}, "touched off"},
    {{OffsetMethod::kProbe, "probe"}, "probed"},         {{OffsetMethod::kByHand, "by_hand"}, "set by hand"},
    {{OffsetMethod::kComputed, "computed"}, "computed"},
};
constexpr auto& rowsOf(OffsetMethod) noexcept { return kOffsetMethods; }

/// What a work offset was set for: the figures of a job that zero points depend on.
struct OffsetBasis {
  OffsetMethod method = OffsetMethod::kUnknown;
  std::string job_name;       ///< the job file's; may be empty
  std::string wheel_name;     ///< the wheel file's; empty if the job has the wheel's figures itself
  std::string wheel_digest;   ///< of the wheel's figures but wear and width; empty if it was set for no particular job
  double end_diameter = 0;    ///< of the cutter [m]
  double wheel_diameter = 0;  ///< to which Y = 0 is set [m]
  double wheel_width = 0;     ///< [m]
  double swivel = 0;          ///< of the job's set-up [rad]
  double height = 0;          ///< of the job's set-up [m]

  bool hasJob() const noexcept { return !wheel_digest.empty(); }
};

/// Where the work stands on an axis, who said so, and for which job.
struct WorkOffset {
  double value = 0;    ///< machine position - work position; NaN if it is unknown, see OffsetStore [m], A [rad]
  std::string set_by;  ///< for people; empty if it was never set
  double set_at = 0;   ///< since the epoch; 0 if it was never set [s]
  OffsetBasis basis{};

  bool wasSet() const noexcept { return set_at > 0; }
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

}  // namespace grinder
