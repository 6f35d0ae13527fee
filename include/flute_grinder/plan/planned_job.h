#pragma once

#include "flute_grinder/collision/job_collision.h"
#include "flute_grinder/geometry/ground_job.h"
#include "flute_grinder/motion/job_plan.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// A job's complete plan. Its program holds the job with its law of Z, the machine, and where the run begins.
struct PlannedJob : JobPlan {
  std::string digest;                   ///< see jobDigest()
  std::optional<Range> complete;        ///< where the flutes would be complete, if that was checked
  CutterFigures figures;                ///< of the tool that it grinds, if that was checked
  std::vector<GroundEdge> edges;        ///< of its teeth, if that was checked
  std::optional<ClosestPlace> closest;  ///< of wheel, machine and cutter, if that was checked; its leg is a move
};

/// Plans a job with its law of Z, and checks the cutter that it grinds and that nothing is hit: withLaws(), planJob(),
/// checkGroundCutter() and checkCollision(). For any job and machine, the result is either good or has reasons. Cutter
/// and collisions are checked, too, of a job whose setpoints are refused; a law of Z that does not exist leaves the
/// result without a program.
/// @param shapes of the machine. @param run, visit, watch as for planJob().
PlannedJob planWholeJob(const ValidJob& job, const Machine& machine, const MachineShapes& shapes, const RunStart& run,
                        const std::function<void(const Setpoint&)>& visit = {}, const PlanWatch& watch = {});

}  // namespace grinder
