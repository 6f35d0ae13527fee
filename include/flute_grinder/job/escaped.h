#pragma once

#include <string>
#include <string_view>

namespace grinder {

/// A text from outside as a terminal, a log or a message may have it: what controls a terminal, and bytes that are not
/// UTF-8, are written as in C++, e.g. `\x1b` and `\t`.
/// @param kept control characters that stay.
std::string escaped(std::string_view text, std::string_view kept = "");

}  // namespace grinder
