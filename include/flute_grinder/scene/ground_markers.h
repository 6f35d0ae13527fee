#pragma once

#include "flute_grinder/geometry/ground_cutter.h"
#include "flute_grinder/job/move_kind.h"
#include "flute_grinder/job/tooth_pass.h"
#include "flute_grinder/scene/markers.h"

#include <optional>

namespace grinder {

class ValidJob;

/// How far a job has come: the pass that runs, and the X that its stroke has reached.
struct Reached {
  ToothPass pass;
  PassPhase phase = PassPhase::kBefore;
  double x = 0;  ///< in the stroke [m]

  bool operator==(const Reached& other) const { return pass == other.pass && phase == other.phase && x == other.x; }
};

/// The cutter as a part of a job leaves it: of each tooth the deepest pass that is done, and the stroke that runs up to
/// where it is. The wheel counts as worn as at the job's begin, since Y takes up what it wears on the way.
/// @throw as groundCutterOf().
GroundCutter groundSoFar(const ValidJob& job, const Reached& reached);

/// The ground cutter with its neck and shank as a solid that is cut open, in the frame `cutter`, its rake faces
/// and primary reliefs coloured by how far they are from the rake and clearance that are asked, where the last pass has
/// been. Before the first stroke of the flutes the whole blank. Below 3 MB.
/// @param reached how far the job has come; nothing for one that is done.
/// @param ns namespace of the markers.
/// @return markers; the first deletes what was shown before. Instead of a cutter that cannot be shown, as one with its
///         core cut through, there is only the reason, as a label.
visualization_msgs::MarkerArray groundMarkers(const GroundCutter& cutter, const ValidJob& job, const char* ns,
                                              const std::optional<Reached>& reached = std::nullopt);

}  // namespace grinder
