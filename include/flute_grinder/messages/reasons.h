#pragma once

#include "flute_grinder/GrindResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Plan.h"
#include "flute_grinder/Reason.h"
#include "flute_grinder/core/reason.h"

#include <string>
#include <vector>

/// @file
/// Reasons as messages, and what the operator reads of them.
namespace flute_grinder {

Reason toMessage(const core::Reason& reason);
std::vector<Reason> toMessage(const std::vector<core::Reason>& reasons);

/// @return a reason of kNone where the message has a kind, axis, unit or move that is not one.
core::Reason fromMessage(const Reason& message);

/// Why the machine is in a fault, or why the last job did not begin, in the operator's units; empty otherwise.
std::string faultText(const GrinderState& state);

/// How a goal ended, in the operator's units; the grinder's own text where it sends no reasons.
std::string resultText(const GrindResult& result);

/// Why a job cannot be ground, in the operator's units; the grinder's own texts where it sends no reasons.
std::vector<std::string> planTexts(const Plan::Response& plan);

}  // namespace flute_grinder
