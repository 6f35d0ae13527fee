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

/// The grinder's activity, the reason for it, and the operator's next step.
std::string describe(const flute_grinder::GrinderState& state);

/// The swivel's angle, measured by the drive or confirmed by a person.
std::string swivelText(const flute_grinder::GrinderState& state);

/// The success message of a request. @param event a request.
std::string done(MachineEvent event);

/// An operation by its place in the job's list and its name, e.g. "2 primary relief". @param index from 0.
std::string operationEntry(int index, OperationKind kind);

/// The operation of a goal; nothing if its file has only one.
std::optional<OperationKind> operationOf(const flute_grinder::GrindGoal& goal);

/// A running job, by its file, operation and tool.
std::string describe(const flute_grinder::GrindGoal& goal);

/// An unfinished job, by its file, its tool and its progress. @param progress not finished.
std::string describe(const flute_grinder::JobProgress& progress);

/// The result of a plan, a line for each item: duration, least distance, zero points that do not fit, limits of the
/// feed; or its violations.
std::string describe(const flute_grinder::GrindResult& planned);

}  // namespace grinder
