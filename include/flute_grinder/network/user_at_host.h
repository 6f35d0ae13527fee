#pragma once

#include <string>

namespace flute_grinder {

/// Who runs this program, as `user@host`: for requests of which the grinder remembers who made them.
std::string userAtHost();

}  // namespace flute_grinder
