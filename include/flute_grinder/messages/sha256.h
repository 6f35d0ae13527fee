#pragma once

#include <cstddef>
#include <string>

namespace flute_grinder {

/// The SHA-256 of some bytes, 64 digits in lower-case hexadecimal.
/// @throw std::runtime_error if the computer cannot compute it.
std::string sha256Hex(const void* bytes, std::size_t count);

}  // namespace flute_grinder
