#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <future>
#include <thread>
#include <vector>

namespace grinder {

/// Calls f(0) to f(count - 1), as many at a time as there are cores. Not for the control cycle: it starts threads.
/// @throw the exception of the first call that threw one, in order, after all calls have ended.
template <typename Function>
void onAllCores(std::size_t count, const Function& f) {
  const std::size_t threads = std::min<std::size_t>(count, std::max(1U, std::thread::hardware_concurrency()));
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};  // a call goes to the thread that is free first: some take longer than others
  std::vector<std::future<void>> workers;
  for (std::size_t t = 0; t < threads; ++t) {
    workers.push_back(std::async(std::launch::async, [&] {
      for (std::size_t i = next++; i < count; i = next++) {
        try {
          f(i);
        } catch (...) {
          errors[i] = std::current_exception();
        }
      }
    }));
  }
  for (std::future<void>& worker : workers) worker.get();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace grinder
