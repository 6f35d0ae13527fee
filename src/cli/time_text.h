#pragma once

#include <string>

namespace grinder {

/// A time to the second: "2026-11-22T17:04:13Z" in UTC, or "2026-11-22 18:04:13" as the clocks here show it.
/// @param time since the epoch [s].
std::string timeText(double time, bool utc);

/// The time of a day or a time in ISO 8601, since the epoch [s]: "2026-11-22", "2026-11-22T18:04", with seconds, or
/// with milliseconds; as the clocks here show it, or in UTC with a Z at its end.
/// @param last of the day, the minute or the second, its last millisecond; else its first.
/// @throw std::invalid_argument naming any other text, and what is allowed.
double timeOfDate(const std::string& text, bool last);

}  // namespace grinder
