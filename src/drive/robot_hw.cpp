#include "flute_grinder/drive/robot_hw.h"

#include <cerrno>
#include <ctime>

namespace grinder {

namespace {

constexpr std::int64_t kSecond = 1000000000;  ///< [ns]

/// [ns]
std::int64_t monotonicNow() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

}  // namespace

JointStateHandle::JointStateHandle(const std::string& name, const double* pos, const double* vel, const double* eff)
    : name_(name), pos_(pos), vel_(vel), eff_(eff) {
  if (!pos || !vel || !eff) throw HardwareInterfaceException("joint state handle '" + name + "' has a null pointer");
}

JointHandle::JointHandle(const JointStateHandle& js, double* cmd) : JointStateHandle(js), cmd_(cmd) {
  if (!cmd) throw HardwareInterfaceException("joint handle '" + js.getName() + "' has a null command pointer");
}

DriveHandle::DriveHandle(const std::string& name, const DriveStatus* status, DriveCommand* command)
    : name_(name), status_(status), command_(command) {
  if (!status || !command) throw HardwareInterfaceException("drive handle '" + name + "' has a null pointer");
}

ros::Duration RobotHW::wait(const ros::Duration& period) {
  const std::int64_t now_ns = monotonicNow();
  next_cycle_ns_ += period.toNSec();
  if (next_cycle_ns_ < now_ns) {
    next_cycle_ns_ = now_ns;
  } else {
    const timespec until{static_cast<time_t>(next_cycle_ns_ / kSecond), static_cast<long>(next_cycle_ns_ % kSecond)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }
  return sinceLastCycle(period);
}

ros::Duration RobotHW::sinceLastCycle(const ros::Duration& nominal) {
  const std::int64_t now_ns = monotonicNow();
  const std::int64_t last_ns = last_cycle_ns_ == 0 ? now_ns - nominal.toNSec() : last_cycle_ns_;
  last_cycle_ns_ = now_ns;
  return ros::Duration().fromNSec(now_ns - last_ns);
}

}  // namespace grinder
