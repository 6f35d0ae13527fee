#pragma once

#include <string>
#include <string_view>

namespace grinder {

/// A text from outside, made safe for a terminal, a log or a message: control characters and bytes that are not UTF-8
/// are written as in C++, e.g. `\x1b` and `\t`.
/// @param kept control characters to leave as they are.
std::string escaped(std::string_view text, std::string_view kept = "");

}  // namespace grinder
