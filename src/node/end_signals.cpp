#include "node/end_signals.h"

#include "flute_grinder/base/await.h"

#include <pthread.h>
#include <ros/ros.h>

#include <cstdlib>
#include <ctime>
#include <utility>

namespace grinder {

namespace {

constexpr std::chrono::milliseconds kLook{10};
constexpr std::chrono::seconds kShutdown{1};  ///< longest time for ros::shutdown()

}  // namespace

EndSignals::EndSignals() {
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

bool EndSignals::await(std::chrono::milliseconds timeout) const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const timespec time{seconds.count(), std::chrono::nanoseconds(timeout - seconds).count()};
  return sigtimedwait(&signals_, nullptr, &time) > 0;
}

EndAtOnce::EndAtOnce(const EndSignals& signals, std::string what)
    : thread_([this, &signals, what = std::move(what)] {
        while (!over_) {
          if (!signals.await(kLook)) continue;
          ROS_WARN_STREAM("ended by a signal before the return of " << what);
          // ros::shutdown() waits for callbacks and for the master, which may hang as well.
          std::thread([] {
            ros::shutdown();
            std::_Exit(0);
          }).detach();
          std::this_thread::sleep_for(kShutdown);
          std::_Exit(0);
        }
      }) {}

EndAtOnce::~EndAtOnce() {
  over_ = true;
  thread_.join();
}

EndInTime::EndInTime(std::string what)
    : thread_([this, what = std::move(what)] {
        if (await(kShutdown, kLook, [this] { return over_.load(); })) return;
        ROS_FATAL_STREAM("the process ends without the return of " << what);
        std::_Exit(1);
      }) {}

EndInTime::~EndInTime() {
  over_ = true;
  thread_.join();
}

}  // namespace grinder
