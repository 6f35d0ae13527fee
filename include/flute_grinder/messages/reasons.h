#pragma once

#include "flute_grinder/Need.h"
#include "flute_grinder/Reason.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/machine/need.h"

#include <vector>

/// @file
/// Reasons and needs as messages.
namespace grinder {

flute_grinder::Reason toMessage(const Reason& reason);
std::vector<flute_grinder::Reason> toMessage(const std::vector<Reason>& reasons);

std::vector<flute_grinder::Need> toMessage(const std::vector<Need>& needs);

}  // namespace grinder
