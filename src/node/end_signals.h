#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace grinder {

/// The signals that end the program: blocked in every thread, because the machine must come to rest before the process
/// ends, and waited for.
class EndSignals {
 public:
  /// Blocks them in this thread and in those that it starts from now on.
  EndSignals();

  /// Waits for one. @return whether there was one.
  bool await(std::chrono::milliseconds timeout) const;

 private:
  sigset_t signals_{};
};

/// While it exists, such a signal ends the process within a second: for what may block for ever, with the power off.
class EndAtOnce {
 public:
  /// @param signals must outlive this object. @param what may block, for the log.
  EndAtOnce(const EndSignals& signals, std::string what);
  ~EndAtOnce();

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// Ends the process, as one that has failed, if it exists for a second: for what may block at the end.
class EndInTime {
 public:
  /// @param what may block, for the log.
  explicit EndInTime(std::string what);
  ~EndInTime();

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

}  // namespace grinder
