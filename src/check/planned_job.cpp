#include "flute_grinder/check/planned_job.h"

#include "flute_grinder/tool/z_law.h"

#include <stdexcept>
#include <vector>

namespace grinder {

namespace {

/// The fault of a plan for which a computation about the tool has this reason.
PlanFault faultOf(const Reason& reason) {
  return reason.kind == ReasonKind::kGivenUp ? PlanFault::kGivenUp : PlanFault::kTool;
}

/// A plan without a program, because there is no law of Z.
JobPlan refused(Reason reason) {
  JobPlan plan;
  plan.fault = faultOf(reason);
  plan.reasons.push_back(std::move(reason));
  return plan;
}

JobPlan planWithLaw(const ValidJob& job, const Machine& machine, const RunStart& run,
                    const std::function<void(const Setpoint&)>& visit, const PlanWatch& watch) {
  std::optional<ValidJob> with_law;
  try {
    with_law = withLaws(job, watch);
  } catch (const ReasonError& error) {
    return refused(error.reason());
  } catch (const std::invalid_argument& error) {
    return refused(otherReason(error.what()));
  }
  return planJob(*with_law, machine, run, visit, watch);
}

void refuse(JobPlan& plan, PlanFault fault, const std::vector<Reason>& reasons) {
  if (plan.good() && !reasons.empty()) plan.fault = fault;
  plan.reasons.insert(plan.reasons.end(), reasons.begin(), reasons.end());
}

}  // namespace

PlannedJob planWholeJob(const ValidJob& job, const Machine& machine, const MachineShapes& shapes, const RunStart& run,
                        const std::function<void(const Setpoint&)>& visit, const PlanWatch& watch) {
  PlannedJob planned{planWithLaw(job, machine, run, visit, watch), {}, {}, {}, {}, {}};
  if (!planned.program || planned.fault == PlanFault::kGivenUp) return planned;
  const PlanWatch after_plan = [&watch](double) { return !watch || watch(1); };
  CutterCheck cutter = checkGroundCutter(planned.program->job(), after_plan);
  planned.complete = cutter.complete;
  planned.figures = cutter.figures;
  planned.edges = std::move(cutter.edges);
  if (!cutter.reasons.empty()) {
    const PlanFault fault = faultOf(cutter.reasons.front());
    refuse(planned, fault, cutter.reasons);
    if (fault == PlanFault::kGivenUp) {
      planned.fault = fault;
      return planned;
    }
  }
  const CollisionResult collision = checkCollision(*planned.program, shapes);
  planned.closest = collision.closest;
  if (collision.reason) refuse(planned, PlanFault::kCollision, {*collision.reason});
  return planned;
}

void measurePasses(PlannedJob& plan, const PlanWatch& watch) {
  if (!plan.good()) return;
  try {
    plan.passes = removalOfPasses(plan.program->job(), watch);
  } catch (const ReasonError& error) {
    refuse(plan, faultOf(error.reason()), {error.reason()});
  }
}

}  // namespace grinder
