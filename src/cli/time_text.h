#pragma once

#include <string>

namespace grinder {

/// A time to the second: "2026-11-22T17:04:13Z" in UTC, or "2026-11-22 18:04:13" as the clocks here show it.
/// @param time since the epoch [s].
std::string timeText(double time, bool utc);

}  // namespace grinder
