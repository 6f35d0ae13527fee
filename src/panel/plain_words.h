#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/GrindResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/machine/machine_state.h"

#include <optional>
#include <string>

namespace grinder {

/// A time, e.g. "7.0 s", "12:05 min" or "1:02:05 h". @param seconds not negative.
std::string duration(double seconds);

/// What the grinder is doing, why, and what to do about it.
std::string describe(const flute_grinder::GrinderState& state);

/// Where the swivel stands, as the drive measures it or somebody has confirmed it.
std::string swivelText(const flute_grinder::GrinderState& state);

/// The success of a request, in a line. @param event a request.
std::string done(MachineEvent event);

/// An operation by its number and name, e.g. "2 primary relief".
std::string operationEntry(OperationKind kind);

/// Which of several operations a goal is; nothing if it is the only one.
std::optional<OperationKind> operationOf(const flute_grinder::GrindGoal& goal);

/// A job that runs, by its file, its operation and its tool.
std::string describe(const flute_grinder::GrindGoal& goal);

/// A job that was begun, by its file and tool, and how far it has come. @param progress not finished.
std::string describe(const flute_grinder::JobProgress& progress);

/// What came of a plan: how long the job takes, what comes closest, why zero points do not fit, what cuts its feed; or
/// its violations. A line for each.
std::string describe(const flute_grinder::GrindResult& planned);

}  // namespace grinder
