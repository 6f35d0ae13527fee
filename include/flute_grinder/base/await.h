#pragma once

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace grinder {

/// Looks whether a condition is true, again after each step, until it is or the time is over. No step counts for more
/// than ten, however long it took: while the whole computer stands still, nobody can make the condition true. Not for
/// the control cycle.
/// @param timeout longest wait, but for steps that took longer.
/// @param step time between two looks, positive.
/// @param condition must return at once.
/// @param rest waits for the time that it is given, or for less.
/// @return whether it came true.
template <typename Condition, typename Rest>
bool await(std::chrono::nanoseconds timeout, std::chrono::nanoseconds step, const Condition& condition,
           const Rest& rest) {
  auto last = std::chrono::steady_clock::now();
  for (std::chrono::nanoseconds waited(0); !condition();) {
    if (waited >= timeout) return false;
    rest(step);
    const auto now = std::chrono::steady_clock::now();
    waited += std::min<std::chrono::nanoseconds>(now - std::exchange(last, now), 10 * step);
  }
  return true;
}

/// As above; sleeps between the looks.
template <typename Condition>
bool await(std::chrono::nanoseconds timeout, std::chrono::nanoseconds step, const Condition& condition) {
  return await(timeout, step, condition, [](std::chrono::nanoseconds time) { std::this_thread::sleep_for(time); });
}

}  // namespace grinder
