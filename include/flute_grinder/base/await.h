#pragma once

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace grinder {

/// Looks whether a condition is true, again after each step, until it is or the time is over. No step counts for more
/// than ten, however long it took: while the whole computer stands still, nobody can make the condition true. Not for
/// the control cycle: it sleeps.
/// @param timeout longest wait, but for steps that took longer.
/// @param step time between two looks, positive.
/// @param condition must return at once.
/// @return whether it came true.
template <typename Condition>
bool await(std::chrono::nanoseconds timeout, std::chrono::nanoseconds step, const Condition& condition) {
  auto last = std::chrono::steady_clock::now();
  for (std::chrono::nanoseconds waited(0); !condition();) {
    if (waited >= timeout) return false;
    std::this_thread::sleep_for(step);
    const auto now = std::chrono::steady_clock::now();
    waited += std::min<std::chrono::nanoseconds>(now - std::exchange(last, now), 10 * step);
  }
  return true;
}

}  // namespace grinder
