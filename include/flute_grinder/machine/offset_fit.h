#pragma once

#include "flute_grinder/machine/need.h"
#include "flute_grinder/motion/work_offsets.h"

#include <optional>
#include <string>
#include <vector>

/// @file
/// The fit of work offsets to a job. The middle of the wheel's width is at (X, D1/2 + Dw/2 + Y, h + Z) of the work. So
/// Y depends on the end diameter and the wheel, Z on the height and the wheel, and X and Z also on swivel and width,
/// since the middle of the wheel need not be on the swivel's axis. All three are valid for one mounting of the wheel
/// only. A is the position of the first tooth: on a bare blank any A fits, but reliefs need the A of their flutes.
namespace grinder {

/// A work offset, or the wheel on the spindle, that does not fit a job.
struct OffsetMismatch {
  std::string what;              ///< "X", "Y", "Z", "A" or "wheel"
  std::string set;               ///< values that it is or was set for and the job does not have, in mm and deg
  std::string asked;             ///< the job's values instead, in mm and deg
  std::string reason;            ///< a sentence with both, and with everything the offset was set for
  int axis = 0;                  ///< axis of the offset to change
  std::optional<double> change;  ///< addition to the offset that makes it fit; nothing if it must be set anew [m]
};

/// The mismatches of offsets and wheel with a job. An offset does not fit if it was never set, if its job is unknown,
/// if it was set for other values than the job's, or with another wheel on the spindle. X alone may be set for no
/// particular job. A matters only for operations after the first, and must then be as the preceding operations left it,
/// or probed on a tooth. No operation is ground twice.
/// @param job the job's values; method is ignored, and so are names for axes that fit.
std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const OffsetBasis& job);

/// Why the work offset of X, Y or Z cannot be corrected for a job: it does not fit it. Empty if it can.
std::string correctionRefusal(const WorkOffsets& offsets, int axis, const OffsetBasis& job);

/// What an operator must say before a job starts with such offsets: a need of the wheel, and one of all the others.
std::vector<Need> needsOf(const std::vector<OffsetMismatch>& mismatches);

/// The job for which a work offset was set, for the operator, e.g. "touched off for D 6 mm, wheel straight_d100_w3.yaml
/// (taper.yaml)", with only the values that the axis depends on; "never set" if it was not set, "cannot be read" if it
/// is unknown.
std::string basisText(int axis, const WorkOffset& offset);

/// The wheel on the spindle, for the operator, e.g. "straight_d100_w3.yaml, D 100 mm"; "not confirmed" if it is
/// unknown.
std::string mountedText(const MountedWheel& wheel);

/// The wheel of a job, in the same format as mountedText().
std::string wheelText(const OffsetBasis& job);

/// Whether the job's wheel is on the spindle.
bool isMounted(const MountedWheel& wheel, const OffsetBasis& job);

/// The operations ground on the tool in the collet, for the operator, e.g. "flutes of taper.yaml; A is as they were
/// ground".
std::string toolText(const ClampedTool& tool);

}  // namespace grinder
