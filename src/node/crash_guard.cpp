#include "flute_grinder/node/crash_guard.h"

#include <atomic>
#include <csignal>
#include <ctime>

namespace flute_grinder {

namespace {

constexpr int kSignals[]{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr int kLongestStop = 1000;                ///< looks at the loop, until it is given up
constexpr timespec kBetweenLooks{0, 10'000'000};  ///< [s, ns]

std::atomic<ControlLoop*> guarded{nullptr};

/// Uses nothing but atomics and system calls: whatever the thread was in the midst of is in ruins.
void onCrash(int signal) {
  if (ControlLoop* loop = guarded) {
    loop->postStop(MachineEvent::kDisable);
    for (int i = 0; i < kLongestStop && isPowered(loop->status().state); ++i) nanosleep(&kBetweenLooks, nullptr);
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

}  // namespace flute_grinder
