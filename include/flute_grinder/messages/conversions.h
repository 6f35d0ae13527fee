#pragma once

#include "flute_grinder/Cutter.h"
#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/PathStatistics.h"
#include "flute_grinder/WrittenSetpoint.h"
#include "flute_grinder/motion/job_plan.h"
#include "flute_grinder/motion/setpoint.h"

#include <vector>

/// @file
/// Conversion of jobs, cutters, statistics and setpoints between messages and core types. Both use SI units.
namespace grinder {

struct GrindJob;

/// The job of a goal, unchecked: a choice that is out of range is kept, so validate() rejects it.
GrindJob jobFromGoal(const flute_grinder::GrindGoal& goal);

/// The goal of a job.
flute_grinder::GrindGoal goalFromJob(const GrindJob& job);

/// @param tooth_angles angles of all teeth [rad].
flute_grinder::Cutter toMessage(const CutterGeometry& cutter, const std::vector<double>& tooth_angles);

/// Everything in a cutter's message except its teeth.
CutterGeometry fromMessage(const flute_grinder::Cutter& message);

flute_grinder::PathStatistics toMessage(const PathStatistics& statistics);
PathStatistics fromMessage(const flute_grinder::PathStatistics& message);

/// @param actual the axis positions reported by the drive when the setpoint was generated [m], A [rad].
/// @param cycle_period measured time from the previous control cycle to the one that generated the setpoint [s].
flute_grinder::WrittenSetpoint toMessage(const Setpoint& setpoint, const Axes& actual, double cycle_period);
Setpoint fromMessage(const flute_grinder::WrittenSetpoint& message);

}  // namespace grinder
