#pragma once

#include "flute_grinder/GrindResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Plan.h"
#include "flute_grinder/Reason.h"
#include "flute_grinder/job/reason.h"

#include <string>
#include <vector>

/// @file
/// Converts reasons to and from messages, and to texts for the operator.
namespace grinder {

flute_grinder::Reason toMessage(const Reason& reason);
std::vector<flute_grinder::Reason> toMessage(const std::vector<Reason>& reasons);

/// @return a reason of kNone if the message has an invalid kind, axis, unit or move.
Reason fromMessage(const flute_grinder::Reason& message);

/// Why the machine is in a fault, or why the last job did not begin, in the operator's units; empty otherwise.
std::string faultText(const flute_grinder::GrinderState& state);

/// How a goal ended, in the operator's units; the grinder's own text if it sent no reasons.
std::string resultText(const flute_grinder::GrindResult& result);

/// Why a job cannot be ground, in the operator's units; the grinder's own texts if it sent no reasons.
std::vector<std::string> planTexts(const flute_grinder::Plan::Response& plan);

}  // namespace grinder
