#pragma once

#include "flute_grinder/job/reason.h"
#include "flute_grinder/motion/job_plan.h"
#include "flute_grinder/tool/ground_cutter.h"
#include "flute_grinder/tool/ground_edge.h"
#include "flute_grinder/tool/tool_figure.h"

#include <optional>
#include <vector>

namespace grinder {

class ValidJob;
struct GrindJob;

/// The wheel of a job, when new.
/// @param job a job that validate() accepts.
/// @throw std::invalid_argument if the corner radii do not fit the profile, with the value and what is allowed.
WheelProfile wheelOf(const GrindJob& job);

/// The set-up of the machine for the strokes of a tooth.
/// @throw like ValidJob::strokeLaw().
WheelSetup setupOf(const ValidJob& job, int tooth);

/// The stroke of a pass of a tooth, as if the tooth were at angle 0.
/// @param tooth from 0.
/// @param depth depth of the pass where the flute is deepest [m].
/// @param wear wear of the wheel's radius, compensated in Y [m].
/// @throw like ValidJob::zCorrectionOf().
GrindStroke strokeOf(const ValidJob& job, int tooth, double depth, double wear);

/// The volume that the wheel removes in a stroke of a tooth.
/// @param tooth from 0.
/// @param wear wear of the wheel's radius [m].
/// @throw like wheelOf().
WheelSweep sweepOf(const ValidJob& job, int tooth, double wear, const GrindStroke& stroke);

/// The cutter that a job grinds: each tooth's deepest pass with the wheel's wear at that time. The passes before it
/// remove nothing more. An operation on the end leaves flutes and reliefs as they are.
/// @throw like wheelOf() and ValidJob::zCorrectionOf().
GroundCutter groundCutterOf(const ValidJob& job);

/// The planned cutter before a relief, from the preceding operations.
/// @param job job of a relief, from withLaws().
/// @param watch if given, it may stop the computation, which takes long where an earlier relief is roughed by removal
/// and the wheel wears in it: see withPasses().
/// @throw ReasonError if it was stopped.
/// @throw like groundCutterOf() and withPasses().
GroundCutter groundBefore(const ValidJob& job, const PlanWatch& watch = {});

/// The results of checking a ground cutter.
struct CutterCheck {
  std::optional<Range> complete;  ///< range of complete flutes; nothing if they are incomplete at the middle
  std::vector<Reason> reasons;    ///< reasons for refusing the cutter
  CutterFigures figures;          ///< figures of flutes and reliefs
  std::vector<GroundEdge> edges;  ///< edges of the teeth
};

/// Measures the ground cutter in nine sections, from one end of the flute to the other: every tooth has a land, the
/// core is whole, rake, chordal rake, spiral angle and core are within the job's tolerances, and the flutes are
/// complete over their length unless the job allows otherwise. The spiral tolerance applies to the edge's angle in each
/// section and to its turn from each section to the next, so the edge leaves the asked helix by no more than a helix at
/// the tolerance would. The asked core is linear between the diameters at the ends. For an operation on the end, the
/// end as planned is measured instead: end teeth, gash and chamfer as asked, edges whole, periphery untouched. Takes
/// some milliseconds.
CutterCheck checkGroundCutter(const ValidJob& job, const GroundCutter& cutter);

/// Checks the cutter that a job grinds; teeth share a flute if the difference of the wheel's wear between them does not
/// matter. Corner radii that do not fit the wheel's profile are also a reason, and so is a stop.
/// @param watch see groundBefore().
CutterCheck checkGroundCutter(const ValidJob& job, const PlanWatch& watch = {});

}  // namespace grinder
