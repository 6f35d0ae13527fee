#pragma once

#include "flute_grinder/control/control_loop.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace grinder {

/// Switches the drive's power off when the control loop hangs in the drive's read(), write() or wait(), and cannot call
/// write() any more.
class LoopWatchdog {
 public:
  /// Interval between looks. The watchdog acts when it has found the same cycle kMostLooks times in a row, after 0.25
  /// s. A stall of the whole computer delays the looks too, and so does not count as a hang.
  static constexpr std::chrono::milliseconds kLook{10};
  static constexpr int kMostLooks = 25;

  /// @param loop loop whose thread has been started: one that never was counts as one that hangs. @param drive the
  /// loop's drive. Both must outlive this object.
  LoopWatchdog(ControlLoop& loop, Drive& drive);
  ~LoopWatchdog();

  /// The state of the loop as the watchdog last found it.
  enum class Finding : std::uint8_t {
    kRuns,
    kSwitchingOff,  ///< the loop hangs, and the drive's powerOff() has not returned
    kHangs,
    kHangsPowerIsOff
  };
  Finding finding() const noexcept;
  bool loopHangs() const noexcept { return finding() != Finding::kRuns; }

 private:
  void run();

  ControlLoop& loop_;
  Drive& drive_;
  std::atomic<Finding> finding_{Finding::kRuns};  ///< result of the last look
  std::atomic<std::uint64_t> hangs_at_{0};        ///< number of cycles at which the loop hangs
  std::mutex mutex_;
  std::condition_variable end_;
  bool ends_ = false;  ///< guarded by the mutex
  std::thread thread_;
};

}  // namespace grinder
