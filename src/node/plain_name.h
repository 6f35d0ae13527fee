#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>

namespace grinder {

constexpr std::size_t kMaxName = 255;  ///< of a job, or of who sets an offset

/// Whether a name from a peer may be kept and shown. Control characters are refused, since names are printed on
/// terminals.
inline bool isPlainName(const std::string& name) {
  const auto controls = [](unsigned char c) { return std::iscntrl(c) != 0; };
  return name.size() <= kMaxName && std::none_of(name.begin(), name.end(), controls);
}

/// Why a name is refused.
inline std::string nameRefusal(const std::string& field, const std::string& name) {
  return field + " has " + std::to_string(name.size()) + " characters; allowed: up to " + std::to_string(kMaxName) +
         ", and none that controls a terminal";
}

}  // namespace grinder
