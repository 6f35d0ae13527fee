#pragma once

#include <cstddef>
#include <string>

namespace grinder {

/// The SHA-256 of `count` bytes, as 64 lower-case hexadecimal digits.
/// @throw std::runtime_error if the hash cannot be computed.
std::string sha256Hex(const void* bytes, std::size_t count);

}  // namespace grinder
