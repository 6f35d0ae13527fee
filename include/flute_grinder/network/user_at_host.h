#pragma once

#include <string>

namespace grinder {

/// The user of this program as `user@host`, for requests whose author the grinder stores.
std::string userAtHost();

}  // namespace grinder
