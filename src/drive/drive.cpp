#include "flute_grinder/drive/drive.h"

#include <cerrno>
#include <ctime>

namespace grinder {

namespace {

constexpr std::int64_t kSecond = 1000000000;  ///< a second [ns]

/// The monotonic clock [ns].
std::int64_t monotonicNow() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

}  // namespace

ros::Duration Drive::wait(const ros::Duration& nominal) {
  const std::int64_t now_ns = monotonicNow();
  next_cycle_ns_ += nominal.toNSec();
  if (next_cycle_ns_ < now_ns) {
    next_cycle_ns_ = now_ns;
  } else {
    const timespec until{static_cast<time_t>(next_cycle_ns_ / kSecond), static_cast<long>(next_cycle_ns_ % kSecond)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }
  return sinceLastCycle(nominal);
}

ros::Duration Drive::sinceLastCycle(const ros::Duration& nominal) {
  const std::int64_t now_ns = monotonicNow();
  const std::int64_t last_ns = last_cycle_ns_ == 0 ? now_ns - nominal.toNSec() : last_cycle_ns_;
  last_cycle_ns_ = now_ns;
  return ros::Duration().fromNSec(now_ns - last_ns);
}

}  // namespace grinder
