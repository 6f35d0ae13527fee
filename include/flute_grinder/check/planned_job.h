#pragma once

#include "flute_grinder/check/job_collision.h"
#include "flute_grinder/motion/job_plan.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/pass_removal.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// A job's complete plan. Its program holds the job with its law of Z, the machine, and the start of the run.
struct PlannedJob : JobPlan {
  std::optional<Range> complete;        ///< range in which the flutes would be complete, if checked
  CutterFigures figures;                ///< figures of the tool, if checked
  std::vector<GroundEdge> edges;        ///< edges of the teeth, if checked
  std::optional<ClosestPlace> closest;  ///< closest place of wheel, machine and cutter, if checked; its leg is a move
  std::optional<std::vector<PassRemoval>> passes;  ///< what each pass of a tooth removes, if measurePasses() was asked
};

/// Plans a job with its law of Z, and checks the ground cutter and collisions: withLaws(), planJob(),
/// checkGroundCutter() and checkCollision(). For any job and machine, the result is either good or has reasons. Cutter
/// and collisions are also checked if the setpoints are refused; without a law of Z the result has no program.
/// @param shapes shapes of the machine.
/// @param run, visit, watch see planJob().
PlannedJob planWholeJob(const ValidJob& job, const Machine& machine, const MachineShapes& shapes, const RunStart& run,
                        const std::function<void(const Setpoint&)>& visit = {}, const PlanWatch& watch = {});

/// Measures what the passes of a good plan remove: removalOfPasses(). Takes some tenths of a second, and so is no part
/// of each plan.
/// @param watch if given, it may stop the computation, which gives up the plan; several threads call it.
void measurePasses(PlannedJob& plan, const PlanWatch& watch = {});

}  // namespace grinder
