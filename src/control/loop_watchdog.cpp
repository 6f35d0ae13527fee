#include "flute_grinder/control/loop_watchdog.h"

#include <pthread.h>

namespace grinder {

namespace {

/// Calls the drive's powerOff(). @return whether the power is off; false if the drive throws.
bool powerOff(Drive& drive) noexcept {
  try {
    return drive.powerOff();
  } catch (...) {
    return false;
  }
}

}  // namespace

LoopWatchdog::LoopWatchdog(ControlLoop& loop, Drive& drive) : loop_(loop), drive_(drive), thread_([this] { run(); }) {}

LoopWatchdog::~LoopWatchdog() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  end_.notify_one();
  thread_.join();
}

LoopWatchdog::Finding LoopWatchdog::finding() const noexcept {
  const Finding finding = finding_;
  // While powerOff() does not return, the thread does not look.
  return finding != Finding::kRuns && loop_.status().cycles != hangs_at_ ? Finding::kRuns : finding;
}

void LoopWatchdog::run() {
  pthread_setname_np(pthread_self(), "watchdog");
  std::uint64_t seen = 0;
  int looks = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!end_.wait_for(lock, kLook, [this] { return ends_; })) {
    const std::uint64_t cycles = loop_.status().cycles;
    if (cycles != seen || loop_.hasEnded()) {
      seen = cycles;
      looks = 0;
      finding_ = Finding::kRuns;
    } else if (++looks == kMostLooks) {
      lock.unlock();
      loop_.beginPowerOff();
      hangs_at_ = cycles;
      finding_ = Finding::kSwitchingOff;
      finding_ = powerOff(drive_) ? Finding::kHangsPowerIsOff : Finding::kHangs;
      loop_.endPowerOff();
      lock.lock();
    }
  }
}

}  // namespace grinder
