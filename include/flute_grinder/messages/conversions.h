#pragma once

#include "flute_grinder/Cutter.h"
#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/PathStatistics.h"
#include "flute_grinder/WrittenSetpoint.h"
#include "flute_grinder/core/grind_job.h"
#include "flute_grinder/core/job_plan.h"
#include "flute_grinder/core/setpoint.h"

#include <string>
#include <vector>

/// @file
/// The one place where messages and the types of core meet. Both are in SI.
namespace flute_grinder {

/// The job of a goal, unchecked: a choice that is out of range stays so, for validate() to refuse.
GrindJob jobFromGoal(const GrindGoal& goal);

/// The goal of a job.
GrindGoal goalFromJob(const GrindJob& job);

/// @param tooth_angles of every tooth [rad].
Cutter toMessage(const CutterGeometry& cutter, const std::vector<double>& tooth_angles);

/// What a cutter's message says but its teeth.
CutterGeometry fromMessage(const Cutter& message);

/// Identifies a job: SHA-256 of its numbers, in hexadecimal. What a goal says beside the job does not count.
/// @throw std::runtime_error if the computer cannot compute it.
std::string jobDigest(const GrindJob& job);

PathStatistics toMessage(const core::PathStatistics& statistics);
core::PathStatistics fromMessage(const PathStatistics& message);

/// @param actual where the drive said the axes were when the setpoint was made [m], A [rad].
/// @param cycle_period measured, from the control cycle before to the one that made the setpoint [s].
WrittenSetpoint toMessage(const Setpoint& setpoint, const Axes& actual, double cycle_period);
Setpoint fromMessage(const WrittenSetpoint& message);

}  // namespace flute_grinder
