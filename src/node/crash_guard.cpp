#include "node/crash_guard.h"

#include <atomic>
#include <csignal>
#include <ctime>

namespace grinder {

namespace {

constexpr int kSignals[]{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr int kMaxChecks = 1000;                   ///< checks of the loop's status before giving up
constexpr timespec kCheckInterval{0, 10'000'000};  ///< interval between checks [s, ns]
/// Time for the telemetry, which publishes every 0.05 s, after the axes are off.
constexpr timespec kReportTime{0, 200'000'000};  ///< 0.2 s [s, ns]

std::atomic<ControlLoop*> guarded{nullptr};

/// Uses only atomics and system calls: the crashed thread may have left any other data inconsistent.
void onCrash(int signal) {
  ControlLoop* loop = guarded;
  if (loop && !loop->isOwnThread()) {
    loop->postStop(MachineEvent::kDisable);
    for (int i = 0; i < kMaxChecks && isPowered(loop->status().state); ++i) nanosleep(&kCheckInterval, nullptr);
    nanosleep(&kReportTime, nullptr);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

void stopAxesOnCrash(ControlLoop& loop) {
  guarded = &loop;
  struct sigaction action {};
  action.sa_handler = onCrash;
  sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

void endCrashGuard() { guarded = nullptr; }

}  // namespace grinder
