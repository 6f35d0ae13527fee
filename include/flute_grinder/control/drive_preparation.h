#pragma once

#include "flute_grinder/base/fault_text.h"
#include "flute_grinder/drive/drive.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace grinder {

/// Calls the drive's prepare() in a thread of its own whenever the control loop asks for it, because it may block.
class DrivePreparation {
 public:
  /// @param drive must outlive this object.
  explicit DrivePreparation(Drive& drive);
  /// Waits until a call in progress has returned.
  ~DrivePreparation();

  enum class State : std::uint8_t { kIdle, kPreparing, kReady, kFailed };

  // For the loop. Real-time safe.
  /// Asks for a call. @return false, and nothing is asked for, while the previous call has not returned.
  bool begin() noexcept;
  State state() const noexcept { return state_.load(std::memory_order_acquire); }
  /// Text of the exception that prepare() threw; valid while the state is kFailed.
  const FaultText& why() const noexcept { return why_; }

 private:
  void run();
  void prepare();

  Drive& drive_;
  std::atomic<State> state_{State::kIdle};
  FaultText why_;  ///< owned by the thread while the state is kPreparing, otherwise by the loop
  std::mutex mutex_;
  std::condition_variable end_;
  bool ends_ = false;  ///< guarded by the mutex
  std::thread thread_;
};

}  // namespace grinder
