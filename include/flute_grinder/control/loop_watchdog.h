#pragma once

#include "flute_grinder/control/control_loop.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace grinder {

/// Switches the drive's power off when the control loop no longer comes round: when read(), write() or wait() of the
/// drive hangs, and nobody is left to call write().
class LoopWatchdog {
 public:
  /// Looks as often as that, and acts when it has found the same cycle kMostLooks times in a row. A computer that
  /// stalls as a whole delays the looks as well, and is no hang: 0.25 s.
  static constexpr std::chrono::milliseconds kLook{10};
  static constexpr int kMostLooks = 25;

  /// @param loop whose thread has been started. @param drive its own. Both must outlive this object.
  LoopWatchdog(ControlLoop& loop, Drive& drive);
  ~LoopWatchdog();

  /// What is known of the loop. Thread safe.
  enum class Finding : std::uint8_t {
    kRuns,
    kSwitchingOff,  ///< it hangs, and the drive's powerOff() has not returned
    kHangs,
    kHangsPowerIsOff
  };
  Finding finding() const noexcept;
  bool loopHangs() const noexcept { return finding() != Finding::kRuns; }

 private:
  void run();

  ControlLoop& loop_;
  Drive& drive_;
  std::atomic<Finding> finding_{Finding::kRuns};  ///< as of the last look
  std::atomic<std::uint64_t> hangs_at_{0};        ///< the cycles done by a loop that hangs
  std::mutex mutex_;
  std::condition_variable end_;
  bool ends_ = false;  ///< guarded by the mutex
  std::thread thread_;
};

}  // namespace grinder
