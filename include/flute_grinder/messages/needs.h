#pragma once

#include "flute_grinder/Need.h"
#include "flute_grinder/machine/need.h"

#include <vector>

namespace grinder {

std::vector<flute_grinder::Need> toMessage(const std::vector<Need>& needs);

}  // namespace grinder
