#pragma once

#include "flute_grinder/Reason.h"
#include "flute_grinder/job/reason.h"

#include <vector>

namespace grinder {

/// Reasons as messages.
flute_grinder::Reason toMessage(const Reason& reason);
std::vector<flute_grinder::Reason> toMessage(const std::vector<Reason>& reasons);

}  // namespace grinder
