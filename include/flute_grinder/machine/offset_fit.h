#pragma once

#include "flute_grinder/motion/work_offsets.h"

#include <optional>
#include <string>
#include <vector>

/// @file
/// Whether work offsets fit a job. The middle of the wheel's width is at (X, D1/2 + Dw/2 + Y, h + Z) of the work. So Y
/// depends on the end diameter and the wheel, Z on the height and the wheel, and X and Z also on swivel and width,
/// since the middle of the wheel need not be on the swivel's axis. All three count for one mounting of the wheel alone.
/// A says where the first tooth is to be: on a bare blank that may be anywhere, but what is ground behind the flutes
/// needs their A.
namespace grinder {

/// A work offset, or the wheel on the spindle, that does not fit a job.
struct OffsetMismatch {
  std::string what;              ///< "X", "Y", "Z", "A" or "wheel"
  std::string set;               ///< what it is or was set for and is not asked, for the operator, in mm and deg
  std::string asked;             ///< what the job has instead, in the same way
  std::string reason;            ///< both in one sentence, with all that it was set for
  int axis = 0;                  ///< whose offset `change` is for
  std::optional<double> change;  ///< to be added to the offset, so that it fits; nothing if it must be set anew [m]
};

/// What does not fit a job. Of the offsets: never set, not known for what, set for other figures than the job's, or
/// with another wheel on the spindle. X alone needs no job: it may have been set as it is, for whatever is ground
/// there. A counts for what is ground behind other operations, and must then be where these have left it, or probed on
/// a tooth. Nothing is ground twice.
/// @param job its figures; method and, for axes that fit, names do not count.
std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const OffsetBasis& job);

/// What a work offset was set for, for the operator, e.g. "touched off for D 6 mm, wheel straight_d100_w3.yaml
/// (taper.yaml)"; only the figures that the axis depends on. "never set" if it was not, "cannot be read" if
/// it is unknown.
std::string basisText(int axis, const WorkOffset& offset);

/// The wheel on the spindle, for the operator, e.g. "straight_d100_w3.yaml, D 100 mm"; "not confirmed" if it is
/// unknown.
std::string mountedText(const MountedWheel& wheel);

/// The wheel of a job in the same way.
std::string wheelText(const OffsetBasis& job);

/// Whether the wheel on the spindle is that of a job.
bool isMounted(const MountedWheel& wheel, const OffsetBasis& job);

/// What is ground on the tool in the collet, for the operator, e.g. "flutes of taper.yaml; A is as they were ground".
std::string toolText(const ClampedTool& tool);

}  // namespace grinder
