#pragma once

#include "flute_grinder/base/escaped.h"

#include <cstddef>
#include <string>

namespace grinder {

constexpr std::size_t kMaxName = 255;  ///< longest name of a job or of the person who sets an offset

/// Whether a name from a peer may be kept and shown. Names are printed on terminals, so one that would have to be
/// escaped() is refused.
inline bool isPlainName(const std::string& name) { return name.size() <= kMaxName && escaped(name) == name; }

/// Why a name is refused.
inline std::string nameRefusal(const std::string& field, const std::string& name) {
  return field + " has " + std::to_string(name.size()) + " characters; allowed: up to " + std::to_string(kMaxName) +
         ", in UTF-8, and none that controls a terminal";
}

}  // namespace grinder
