#pragma once

#include "flute_grinder/drive/drive.h"
#include "flute_grinder/job/fault_text.h"

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
  /// Waits for a call that has not returned.
  ~DrivePreparation();

  enum class State : std::uint8_t { kIdle, kPreparing, kReady, kFailed };

  // For the loop. Real-time safe.
  /// @return false while the call before has not returned; nothing is asked for then.
  bool begin() noexcept;
  State state() const noexcept { return state_.load(std::memory_order_acquire); }
  /// What prepare() has thrown, while the state is kFailed.
  const FaultText& why() const noexcept { return why_; }

 private:
  void run();
  void prepare();

  Drive& drive_;
  std::atomic<State> state_{State::kIdle};
  FaultText why_;  ///< of the thread while the state is kPreparing, of the loop otherwise
  std::mutex mutex_;
  std::condition_variable end_;
  bool ends_ = false;  ///< guarded by the mutex
  std::thread thread_;
};

}  // namespace grinder
