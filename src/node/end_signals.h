#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace grinder {

/// The signals that end the program. They are blocked in every thread and waited for, because the machine must come to
/// rest before the process ends.
class EndSignals {
 public:
  /// Blocks the signals in this thread and in all threads that it starts from now on.
  EndSignals();

  /// Waits for a signal. @return whether one came in time.
  bool await(std::chrono::milliseconds timeout) const;

 private:
  sigset_t signals_{};
};

/// While an object of this class exists, a signal of EndSignals ends the process within a second. For calls that may
/// block for ever, with the power off.
class EndAtOnce {
 public:
  /// @param signals must outlive this object. @param what name of the call, for the log.
  EndAtOnce(const EndSignals& signals, std::string what);
  ~EndAtOnce();

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// Ends the process with failure if an object of this class exists for a second. For calls that may block at the end.
class EndInTime {
 public:
  /// @param what name of the call, for the log.
  explicit EndInTime(std::string what);
  ~EndInTime();

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

}  // namespace grinder
