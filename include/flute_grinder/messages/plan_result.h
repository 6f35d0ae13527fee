#pragma once

#include "flute_grinder/GrindResult.h"
#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/machine/loop_fault.h"
#include "flute_grinder/tool/tool_figure.h"

#include <cstddef>
#include <string>

/// @file
/// A plan as the result of a goal, and the texts about it that command line and panel share.
namespace grinder {

/// The GrindResult code for a refused plan.
int errorCode(PlanFault fault);
/// The GrindResult code for a fault that ended a job.
int errorCode(FaultKind fault);

/// The result of a goal that is planned but not run. The caller adds offsets and warnings.
flute_grinder::GrindResult resultOf(const PlannedJob& plan);

GroundFigure fromMessage(const flute_grinder::ToolFigure& message);

/// Depth, area and rate of a pass, as "0.4000 mm, 0.31 mm^2, 2.1 mm^3/s"; or the depth, and that it removes nothing.
/// @param number index in PlanReport::passes.
std::string passText(const flute_grinder::PlanReport& plan, std::size_t number);

/// "wheel and blank, 0.512 mm at X 3.000 mm"; empty if it was not checked.
std::string closestText(const flute_grinder::PlanReport& plan);

/// "axis A velocity, X 0.000 to 30.000 mm"
std::string text(const flute_grinder::FeedLimit& limit);

}  // namespace grinder
