#pragma once

#include "flute_grinder/motion/work_offsets.h"

#include <optional>
#include <string>
#include <vector>

/// @file
/// Whether work offsets fit a job. The middle of the wheel's width is at (X, D1/2 + Dw/2 + Y, h + Z) of the work. So Y
/// depends on the end diameter and the wheel, Z on the height and the wheel, and X and Z also on swivel and width,
/// since the middle of the wheel need not be on the swivel's axis. A depends on nothing: it says where the first tooth
/// is to be, and on a bare blank that may be anywhere.
namespace grinder {

/// An axis whose work offset does not fit a job.
struct OffsetMismatch {
  int axis = 0;
  std::string reason;            ///< for the operator, in mm and deg
  std::optional<double> change;  ///< to be added to the offset, so that it fits; nothing if it must be set anew [m]
};

/// The axes whose offsets do not fit a job: never set, not known for what, or set for other figures than the job's.
/// X alone needs no job: it may have been set as it is, for whatever is ground there.
/// @param job its figures; method and, for axes that fit, names do not count.
std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const OffsetBasis& job);

/// What a work offset was set for, for the operator, e.g. "touched off for D 6 mm, wheel straight_d100_w3.yaml
/// (taper.yaml)"; only the figures that the axis depends on. "never set" if it was not, "cannot be read" if
/// it is unknown.
std::string basisText(int axis, const WorkOffset& offset);

}  // namespace grinder
