#pragma once

#include <cstdlib>
#include <cstring>
#include <random>

namespace grinder::test_support {

/// Numbers between two ends, always the same ones.
inline auto numbers(unsigned seed) {
  return [random = std::mt19937(seed)](double low, double high) mutable {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
}

/// How many random cases a search of its own tries, scaled as RapidCheck's are by RC_PARAMS.
/// @param usual with RapidCheck's 100; as many as take at most 5 s of processor.
inline int randomCases(int usual) {
  const char* const params = std::getenv("RC_PARAMS");
  const char* const more = params ? std::strstr(params, "max_success=") : nullptr;
  return more ? std::atoi(more + std::strlen("max_success=")) * usual / 100 : usual;
}

}  // namespace grinder::test_support
