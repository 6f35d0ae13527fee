#pragma once

#include <string>
#include <string_view>

namespace flute_grinder {

/// Text as by std::printf, of any length.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

/// Whether a text has the form of another, in which 0 stands for any digit, e.g. "0000-00-00".
bool hasForm(std::string_view text, std::string_view form);

}  // namespace flute_grinder
