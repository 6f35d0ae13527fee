#pragma once

#include <string>

namespace grinder {

/// Who runs this program, as `user@host`: for requests of which the grinder remembers who made them.
std::string userAtHost();

}  // namespace grinder
