#include "flute_grinder/control/realtime.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>

namespace flute_grinder {

namespace {

/// Above every ordinary thread, below the kernel's own.
constexpr int kRealtimePriority = 80;

/// More than the loop's calls take by far.
constexpr std::size_t kStack = std::size_t{256} * 1024;
constexpr std::size_t kPage = 4096;

/// Memory that is locked as it is touched must be touched before it counts.
__attribute__((noinline)) void touchStack() {
  volatile char stack[kStack];
  for (std::size_t i = 0; i < kStack; i += kPage) stack[i] = 0;
  static_cast<void>(stack[0]);
}

}  // namespace

bool lockMemory() {
  rlimit limit{};
  const bool unlimited = geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
  // What is there is the loop's and is made resident. What comes later is the ROS side's: a claim of 2 GB, which a few
  // bytes from outside can cause, must not take the memory before it is filled.
  return unlimited && mlockall(MCL_CURRENT) == 0 && mlockall(MCL_FUTURE | MCL_ONFAULT) == 0;
}

bool becomeRealtime() {
  // A signal to the process, also one that tells of a crash elsewhere, is for another thread to take: this one has the
  // axes to stop. A crash of its own ends the process as ever, since such a signal cannot be kept back.
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  touchStack();
  sched_param parameters{};
  parameters.sched_priority = kRealtimePriority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace flute_grinder
