#pragma once

#include "flute_grinder/curve/enum_table.h"
#include "flute_grinder/job/axes.h"

#include <array>
#include <cstdint>
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
  std::string wheel_name;     ///< the wheel file's; profile and width if the job has the wheel's figures itself
  std::string wheel_digest;   ///< of the wheel's figures but wear and width; empty if it was set for no particular job
  double end_diameter = 0;    ///< of the cutter [m]
  double wheel_diameter = 0;  ///< to which Y = 0 is set [m]
  double wheel_width = 0;     ///< [m]
  double swivel = 0;          ///< of the job's set-up [rad]
  double height = 0;          ///< of the job's set-up [m]
  std::string tool_digest;    ///< toolDigest() of the job; empty if it was set for no particular job
  int operation = 0;          ///< of the job, as GrindJob::operation

  bool hasJob() const noexcept { return !wheel_digest.empty(); }
};

/// Where the work stands on an axis, who said so, and for which job.
struct WorkOffset {
  double value = 0;    ///< machine position - work position; NaN if it is unknown, see OffsetStore [m], A [rad]
  std::string set_by;  ///< for people; empty if it was never set
  double set_at = 0;   ///< since the epoch; 0 if it was never set [s]
  OffsetBasis basis{};
  std::uint32_t mounting = 0;  ///< MountedWheel::mounting when it was set

  bool wasSet() const noexcept { return set_at > 0; }
};

/// The wheel on the spindle, as an operator has confirmed it.
struct MountedWheel {
  std::string name;            ///< as OffsetBasis::wheel_name
  std::string digest;          ///< as OffsetBasis::wheel_digest; empty until one is confirmed
  double diameter = 0;         ///< nominal [m]
  std::uint32_t mounting = 0;  ///< grows with every change of the wheel: X, Y and Z count for one mounting alone

  bool isKnown() const noexcept { return !digest.empty(); }
};

/// Why the place of the teeth is not known.
enum class TeethUnknown { kNeverGround, kClamped, kHomed, kSet };

struct TeethUnknownRow : EnumRow<TeethUnknown> {
  const char* reason = "";  ///< a sentence for people
};

/// With the names used in files and messages.
inline constexpr TeethUnknownRow kTeethUnknown[]{
    {{TeethUnknown::kNeverGround, "never_ground"}, "no flutes were ground"},
    {{TeethUnknown::kClamped, "clamped"}, "the tool was clamped anew"},
    {{TeethUnknown::kHomed, "homed"}, "the axes were homed after the flutes"},
    {{TeethUnknown::kSet, "set"}, "the zero point of A was set after the flutes"},
};
constexpr auto& rowsOf(TeethUnknown) noexcept { return kTeethUnknown; }

/// The tool in the collet: whose teeth stand where the work offset of A says, and what is ground on it.
struct ClampedTool {
  std::string digest;        ///< toolDigest(); empty if the place of its teeth is not known
  std::string job_name;      ///< of the job that ground or probed them; may be empty
  std::uint32_t ground = 0;  ///< a bit for each of the tool's operations that is finished, from the lowest
  TeethUnknown unknown = TeethUnknown::kNeverGround;  ///< why, without a digest
  std::uint32_t clamping = 0;  ///< grows whenever a tool is clamped: an unfinished job goes on in one clamping alone

  /// @param operation of any size: a message may ask for one that there is not.
  bool isGround(int operation) const noexcept {
    return operation >= 0 && operation < 32 && ((ground >> operation) & 1U) != 0;
  }
  /// Its teeth are where nobody knows.
  void forget(TeethUnknown why) { *this = {"", "", 0, why, clamping}; }
};

/// The work offset of every axis. The coordinates of a job are the work's; those of limits, park position, homing and
/// drive are the machine's. With the offsets goes what they depend on and only an operator or a job knows.
struct WorkOffsets {
  std::array<WorkOffset, kAxisCount> axes;
  MountedWheel wheel{};
  ClampedTool tool{};

  /// [m], A [rad]
  Axes values() const noexcept {
    Axes values;
    for (int axis = 0; axis < kAxisCount; ++axis) values[axis] = axes[static_cast<std::size_t>(axis)].value;
    return values;
  }
};

}  // namespace grinder
