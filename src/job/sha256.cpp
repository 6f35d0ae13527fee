#include "flute_grinder/job/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <cstdint>
#include <stdexcept>

namespace grinder {

std::string sha256Hex(const void* bytes, std::size_t count) {
  std::array<std::uint8_t, 32> digest{};
  if (EVP_Digest(bytes, count, digest.data(), nullptr, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 cannot be computed");
  }
  std::string text;
  for (const std::uint8_t byte : digest) {
    constexpr const char* digits = "0123456789abcdef";
    text += {digits[byte >> 4], digits[byte & 15]};
  }
  return text;
}

}  // namespace grinder
