#pragma once

#include <string>

namespace flute_grinder {

/// Text as by std::printf, of any length.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace flute_grinder
