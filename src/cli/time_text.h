#pragma once

#include <string>

namespace grinder {

/// A time to the second: "2026-11-22T17:04:13Z" in UTC, or "2026-11-22 18:04:13" in local time.
/// @param time since the epoch [s].
std::string timeText(double time, bool utc);

/// The time since the epoch [s] of a day or time in ISO 8601: "2026-11-22", "2026-11-22T18:04", with seconds or with
/// milliseconds; in local time, or in UTC with a Z at the end.
/// @param last whether the last millisecond of the day, minute or second is meant, or else the first.
/// @throw std::invalid_argument for any other text, naming the allowed ones.
double timeOfDate(const std::string& text, bool last);

}  // namespace grinder
