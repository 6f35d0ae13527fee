#pragma once

#include <chrono>
#include <thread>

namespace grinder::test_support {

/// Whether a condition comes to hold. What a test waits for comes at once; the time only ends a test that has failed.
template <typename Condition>
bool soon(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

}  // namespace grinder::test_support
