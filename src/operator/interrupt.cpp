#include "flute_grinder/operator/interrupt.h"

#include <atomic>
#include <csignal>

namespace flute_grinder {

namespace {

std::atomic<int> count{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use nothing else");

void onSignal(int) { ++count; }

}  // namespace

void catchInterrupts() {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  if (std::signal(SIGHUP, onSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

int interrupts() { return count; }

}  // namespace flute_grinder
