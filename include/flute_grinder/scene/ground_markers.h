#pragma once

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/move_kind.h"
#include "flute_grinder/job/tooth_pass.h"
#include "flute_grinder/motion/setpoint.h"
#include "flute_grinder/scene/markers.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <optional>

namespace grinder {

class ValidJob;

/// The progress of a job: the running pass, and the X that its stroke has reached.
struct Reached {
  ToothPass pass;
  PassPhase phase = PassPhase::kBefore;
  double x = 0;  ///< X reached in the stroke [m]

  /// Updates the progress by a setpoint and the measured position. What is ground remains so when the wheel goes back
  /// along the stroke.
  /// @param actual position of the axes in work coordinates, which may be NaN [m], A [rad].
  void add(const Setpoint& setpoint, const Axes& actual, StrokeDirection direction);

  bool operator==(const Reached& other) const { return pass == other.pass && phase == other.phase && x == other.x; }
};

/// The partly ground cutter: the deepest finished pass of each tooth, and the running stroke up to its present
/// position. The wheel has the wear of the job's start, since Y compensates for further wear.
/// @throw like groundCutterOf().
GroundCutter groundSoFar(const ValidJob& job, const Reached& reached);

/// The ground cutter with neck and shank, in the frame `cutter`. Where the last pass has been, rake faces and primary
/// reliefs are coloured by their difference from the asked rake and clearance. On the end, strokes count once they have
/// ended. Before the first stroke of the flutes, the whole blank. Below 3 MB.
/// @param reached progress of the job; nothing for a finished job.
/// @param ns namespace of the markers except those in kCutOut.
/// @return markers; the first deletes the earlier ones. For a cutter that cannot be shown, e.g. with its core cut
///        through, only a label with the reason.
visualization_msgs::MarkerArray groundMarkers(const GroundCutter& cutter, const ValidJob& job, const char* ns,
                                              const std::optional<Reached>& reached = std::nullopt);

}  // namespace grinder
