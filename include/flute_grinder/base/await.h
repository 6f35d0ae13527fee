#pragma once

#include <chrono>
#include <thread>

namespace grinder {

/// Looks again and again whether a condition is true, until it is or has been waited for long enough. Counts its steps
/// rather than the time on the clock: while the whole computer stands still, nobody can answer. Not for the control
/// cycle: it sleeps.
/// @param step time between two looks.
/// @return whether it came true.
template <typename Condition>
bool await(std::chrono::nanoseconds timeout, std::chrono::nanoseconds step, const Condition& condition) {
  for (std::chrono::nanoseconds left = timeout; !condition(); left -= step) {
    if (left <= std::chrono::nanoseconds(0)) return false;
    std::this_thread::sleep_for(step);
  }
  return true;
}

}  // namespace grinder
