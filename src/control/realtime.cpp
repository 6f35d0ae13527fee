#include "flute_grinder/control/realtime.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <fstream>
#include <system_error>

namespace grinder {

namespace {

/// Priority above all ordinary threads, below the kernel's threads.
constexpr int kRealtimePriority = 80;

/// Stack to make resident, far more than the loop uses.
constexpr std::size_t kStack = std::size_t{256} * 1024;
/// Stack of a thread, far more than any thread of the node uses.
constexpr std::size_t kThreadStack = std::size_t{512} * 1024;
constexpr std::size_t kPage = 4096;
constexpr std::size_t kSpare = std::size_t{2} << 30;

/// With memory that is locked on first access, the stack must be accessed before the first cycle.
__attribute__((noinline)) void touchStack() {
  volatile char stack[kStack];
  for (std::size_t i = 0; i < kStack; i += kPage) stack[i] = 0;
  static_cast<void>(stack[0]);
}

}  // namespace

void boundThreadStacks() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kThreadStack);
  const int error = pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "the size of threads' stacks");
}

void boundAddressSpace() {
#ifndef __SANITIZE_ADDRESS__  // which uses terabytes of addresses
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit limit{};
  const bool known = pages > 0 && getrlimit(RLIMIT_AS, &limit) == 0;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, pages * kPage + kSpare);
  if (!known || setrlimit(RLIMIT_AS, &limit) != 0) {
    throw std::system_error(errno, std::generic_category(), "the limit of the address space");
  }
#endif
}

bool lockMemory() {
  rlimit limit{};
  const bool unlimited = geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
  // Memory allocated so far belongs to the loop and becomes resident now. Later allocations come from ROS: an
  // allocation of 2 GB, which a few bytes from a peer can cause, must not take up memory before it is filled.
  return unlimited && mlockall(MCL_CURRENT) == 0 && mlockall(MCL_FUTURE | MCL_ONFAULT) == 0;
}

bool becomeRealtime() {
  // Other threads handle the process's signals, even for a crash elsewhere: this thread has to stop the axes. A crash
  // in this thread still ends the process, because that signal cannot be blocked.
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  touchStack();
  sched_param parameters{};
  parameters.sched_priority = kRealtimePriority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace grinder
