#include "flute_grinder/control/control_loop.h"

#include "flute_grinder/control/realtime.h"

#include <pthread.h>

#include <chrono>
#include <cstdint>
#include <limits>

// Construction and the thread; the cycle is in control_loop.cpp.
namespace grinder {

namespace {

/// time + period, at most the last stamp that ROS can represent, in 2106. @param period not negative.
ros::Time after(const ros::Time& time, const ros::Duration& period) noexcept {
  const ros::Time last(std::numeric_limits<std::uint32_t>::max(), 0);
  const bool is_last = last.toNSec() - time.toNSec() < static_cast<std::uint64_t>(period.toNSec());
  return is_last ? last : time + period;
}

}  // namespace

ControlLoop::ControlLoop(Drive& drive, const LoopConfig& config, const Wheel& wheel)
    : RequestBox(config.enable_timeout),
      now_(config, wheel),
      link_(drive, now_.config),
      drive_checks_(now_.config),
      power_(drive, capabilities().prepares, now_.config, drive_checks_),
      job_(now_, *this),
      jog_(now_, *this, job_) {
  status_.store(now_.status);
}

ControlLoop::~ControlLoop() { stopThread(); }

void ControlLoop::startThread() {
  running_ = true;
  memory_locked_ = lockMemory();
  thread_ = std::thread([this] { run(); });
}

void ControlLoop::stopThread() {
  if (!thread_.joinable()) return;
  running_ = false;
  thread_.join();
}

void ControlLoop::run() {
  own_thread_ = pthread_self();
  pthread_setname_np(pthread_self(), "control_loop");
  realtime_scheduling_ = becomeRealtime();
  // The system clock, because ROS time may stay at 0 until a simulation publishes it.
  const ros::WallTime wall = ros::WallTime::now();
  // The first wait returns the nominal period at once; no stamp may be ahead of the clock.
  using Clock = DriveLink::Clock;
  const ros::Duration nominal(config().machine.period);
  ros::Time time = ros::Time(wall.sec, wall.nsec) - nominal;
  Clock::time_point begin = Clock::now() - std::chrono::nanoseconds(nominal.toNSec());
  while (running_) {
    const ros::Duration period = link_.wait(begin);
    begin = Clock::now();
    time = after(time, period);
    cycle(time, period);
    now_.sample.busy = std::chrono::duration<double>(Clock::now() - begin).count();
  }
  DriveCommand off;
  Eigen::Map<Axes>(off.position.data()) = now_.sample.command;
  link_.write({time, nominal, nominal}, off);
  ended_ = true;
}

bool ControlLoop::setFeedOverride(double fraction) {
  if (!(fraction >= 0 && fraction <= kMaxFeedOverride)) return false;
  feed_override_ = fraction;
  return true;
}

}  // namespace grinder
