#include "flute_grinder/drive/robot_hw.h"

#include <cerrno>
#include <ctime>

namespace flute_grinder {

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

void RobotHW::wait(const ros::Duration& period) {
  constexpr std::int64_t second = 1000000000;
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t now_ns = now.tv_sec * second + now.tv_nsec;
  next_cycle_ns_ += period.toNSec();
  if (next_cycle_ns_ < now_ns) {
    next_cycle_ns_ = now_ns;
    return;
  }
  const timespec until{static_cast<time_t>(next_cycle_ns_ / second), static_cast<long>(next_cycle_ns_ % second)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace flute_grinder
