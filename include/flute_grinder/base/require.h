#pragma once

namespace grinder {

/// Refuses a number with the text "name = value unit; allowed: what".
/// @param unit with a space before it, e.g. " m". @throw std::invalid_argument unless `good`.
void require(bool good, const char* name, double value, const char* allowed, const char* unit = "");

}  // namespace grinder
