#include "cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace grinder {

namespace {

std::atomic<int> interrupt_count{0}, hold_count{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use nothing else");

void onInterrupt(int) { ++interrupt_count; }
void onHold(int) { ++hold_count; }

}  // namespace

void catchInterrupts() {
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
  if (std::signal(SIGHUP, onInterrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

int interrupts() { return interrupt_count; }

void catchHolds() { std::signal(SIGTSTP, onHold); }

int holds() { return hold_count; }

}  // namespace grinder
