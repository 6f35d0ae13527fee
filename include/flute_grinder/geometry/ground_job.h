#pragma once

#include "flute_grinder/geometry/ground_cutter.h"
#include "flute_grinder/geometry/ground_edge.h"
#include "flute_grinder/geometry/tool_figure.h"
#include "flute_grinder/job/reason.h"

#include <optional>
#include <vector>

namespace grinder {

class ValidJob;
struct GrindJob;

/// The wheel of a job, when new.
/// @param job a job that validate() accepts.
/// @throw std::invalid_argument if the corner radii do not fit the profile, with the value and what is allowed.
WheelProfile wheelOf(const GrindJob& job);

/// How the machine is set for the strokes of a tooth. @throw as ValidJob::strokeLaw().
WheelSetup setupOf(const ValidJob& job, int tooth);

/// The stroke of a pass of a tooth, as if the tooth were at angle 0.
/// @param tooth from 0. @param depth of the pass where the flute is deepest [m]. @param wear of the wheel, taken up by
///        Y [m]. @throw as ValidJob::zCorrectionOf().
GrindStroke strokeOf(const ValidJob& job, int tooth, double depth, double wear);

/// What the wheel removes in a stroke of a tooth.
/// @param tooth from 0. @param wear of the wheel [m]. @throw as wheelOf().
WheelSweep sweepOf(const ValidJob& job, int tooth, double wear, const GrindStroke& stroke);

/// The cutter that a job grinds: each tooth's deepest pass with the wheel as worn by then. The passes before remove
/// nothing more. @throw as wheelOf() and ValidJob::zCorrectionOf().
GroundCutter groundCutterOf(const ValidJob& job);

/// The cutter that the operations ahead of a relief leave, as planned. @param job of a relief, from withLaws().
GroundCutter groundBefore(const ValidJob& job);

/// What a ground cutter was found to be.
struct CutterCheck {
  std::optional<Range> complete;  ///< where its flutes are complete; nothing if they are not amid the flute
  std::vector<Reason> reasons;    ///< why it is refused
  CutterFigures figures;          ///< of its flutes and reliefs
  std::vector<GroundEdge> edges;  ///< of the teeth
};

/// Measures the ground cutter in nine sections, from one end of the flute to the other: every tooth has a land, the
/// core is whole, rake, chordal rake, spiral angle and core are within the job's tolerances, and the flutes are
/// complete over their length unless the job allows otherwise. The spiral tolerance holds for the edge's own angle in a
/// section and for how far it turns from each to the next, so that the edge departs from the asked helix by no more
/// than the tolerance makes over the travel. The core is asked along the straight line between the diameters at the
/// ends. Takes some milliseconds.
CutterCheck checkGroundCutter(const ValidJob& job, const GroundCutter& cutter);

/// The same of the cutter that a job grinds; teeth share a flute where the wheel's wear between them does not count. A
/// wheel whose corner radii do not fit its profile is a reason too.
CutterCheck checkGroundCutter(const ValidJob& job);

}  // namespace grinder
