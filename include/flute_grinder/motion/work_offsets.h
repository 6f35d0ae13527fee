#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/job/grind_job.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>

namespace grinder {

/// Maximum magnitude of a work offset: beyond the travel of any axis, with a rounding far below the resolution of any
/// encoder [m], A [rad].
constexpr double kMaxOffset = 1000;

/// The way in which a work offset was set.
enum class OffsetMethod { kUnknown, kTouchOff, kProbe, kByHand, kComputed, kCorrection };

struct OffsetMethodRow : EnumRow<OffsetMethod> {
  const char* done = "set";  ///< participle for a sentence: "Y was ..."
};

/// Each method with its name in files and messages.
inline constexpr OffsetMethodRow kOffsetMethods[]{
    {{OffsetMethod::kUnknown, "unknown"}, "set"},        {{OffsetMethod::kTouchOff, "touch_off"}, "touched off"},
    {{OffsetMethod::kProbe, "probe"}, "probed"},         {{OffsetMethod::kByHand, "by_hand"}, "set by hand"},
    {{OffsetMethod::kComputed, "computed"}, "computed"}, {{OffsetMethod::kCorrection, "correction"}, "corrected"},
};
constexpr auto& rowsOf(OffsetMethod) noexcept { return kOffsetMethods; }

/// The job for which a work offset was set, by the values that zero points depend on.
struct OffsetBasis {
  OffsetMethod method = OffsetMethod::kUnknown;
  std::string job_name;       ///< name of the job file; may be empty
  std::string wheel_name;     ///< name of the wheel file; profile and width if the job describes the wheel itself
  std::string wheel_digest;   ///< digest of the wheel except wear and width; empty if set for no particular job
  double end_diameter = 0;    ///< end diameter of the cutter [m]
  double wheel_diameter = 0;  ///< wheel diameter to which Y = 0 is set [m]
  double wheel_width = 0;     ///< width of the wheel [m]
  double wheel_rim = 0;       ///< width of a cup's rim; 0 if it does not matter [m]
  double swivel = 0;          ///< swivel of the job's set-up [rad]
  double height = 0;          ///< height of the job's set-up [m]
  std::string tool_digest;    ///< toolDigest() of the job; empty if the offset was set for no particular job
  OperationKind kind{};       ///< kind of the job's operation
  OperationKind before{};     ///< kind of the operation before it in the job's list; of no meaning for the flutes

  bool hasJob() const noexcept { return !wheel_digest.empty(); }
};

/// Values of the work offsets of some axes [m], A [rad].
using OffsetValues = std::map<int, double>;

/// The work offset of an axis, with who set it and for which job.
struct WorkOffset {
  double value = 0;    ///< machine position - work position; NaN if it is unknown, see OffsetStore [m], A [rad]
  std::string set_by;  ///< who set it, for people; empty if it was never set
  double set_at = 0;   ///< time of setting since the epoch; 0 if it was never set [s]
  OffsetBasis basis{};
  std::uint32_t mounting = 0;  ///< MountedWheel::mounting when it was set
  double found_at = 0;         ///< time of setting other than by a correction, since the epoch; 0 if never [s]

  bool wasSet() const noexcept { return set_at > 0; }
};

/// The wheel on the spindle, as an operator has confirmed it.
struct MountedWheel {
  std::string name;            ///< name, see OffsetBasis::wheel_name
  std::string digest;          ///< digest, see OffsetBasis::wheel_digest; empty until a wheel is confirmed
  double diameter = 0;         ///< nominal diameter [m]
  double rim = 0;              ///< width of a cup's rim; 0 if it does not matter [m]
  std::uint32_t mounting = 0;  ///< number that grows with every wheel change; X, Y and Z count for one mounting

  bool isKnown() const noexcept { return !digest.empty(); }
};

/// Why the position of the teeth is unknown.
enum class TeethUnknown { kNeverGround, kClamped, kHomed, kSet };

struct TeethUnknownRow : EnumRow<TeethUnknown> {
  const char* reason = "";  ///< a sentence for people
};

/// Each reason with its name in files and messages.
inline constexpr TeethUnknownRow kTeethUnknown[]{
    {{TeethUnknown::kNeverGround, "never_ground"}, "no flutes were ground"},
    {{TeethUnknown::kClamped, "clamped"}, "the tool was clamped anew"},
    {{TeethUnknown::kHomed, "homed"}, "the axes were homed after the flutes"},
    {{TeethUnknown::kSet, "set"}, "the zero point of A was set after the flutes"},
};
constexpr auto& rowsOf(TeethUnknown) noexcept { return kTeethUnknown; }

/// The tool in the collet: the tool whose teeth the work offset of A refers to, and the operations ground on it.
struct ClampedTool {
  std::string digest;                                 ///< toolDigest(); empty if the position of its teeth is unknown
  std::string job_name;                               ///< name of the job that ground or probed the teeth; may be empty
  std::uint32_t ground = 0;                           ///< finished operations of the tool, see bitOf()
  TeethUnknown unknown = TeethUnknown::kNeverGround;  ///< cause of an empty digest
  std::uint32_t clamping = 0;  ///< grows with every clamping; an unfinished job continues only in the same one

  /// The bit of an operation in `ground`; 0 for a kind that does not exist, which a message may name.
  static constexpr std::uint32_t bitOf(OperationKind kind) noexcept {
    return static_cast<int>(kind) < countOf<OperationKind>() ? 1U << static_cast<unsigned>(kind) : 0;
  }
  bool isGround(OperationKind kind) const noexcept { return (ground & bitOf(kind)) != 0; }
  /// Records that the position of the teeth is unknown.
  void forget(TeethUnknown why) { *this = {"", "", 0, why, clamping}; }
};

/// The work offsets of all axes. Jobs use work coordinates; limits, park position, homing and drive use machine
/// coordinates. Stored together with the state that the offsets depend on and that only an operator or a job knows.
struct WorkOffsets {
  std::array<WorkOffset, kAxisCount> axes;
  MountedWheel wheel{};
  ClampedTool tool{};

  /// Machine position - work position of every axis [m], A [rad].
  Axes values() const noexcept {
    Axes values;
    for (int axis = 0; axis < kAxisCount; ++axis) values[axis] = axes[static_cast<std::size_t>(axis)].value;
    return values;
  }
};

}  // namespace grinder
