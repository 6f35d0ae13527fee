#pragma once

#include <ros/callback_queue.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

namespace grinder {

/// A callback queue and the one thread that serves it. Data used only by its callbacks and by `poll` needs no lock.
class ServedQueue {
 public:
  ServedQueue();
  /// @param period time between calls of `poll` [s].
  ServedQueue(double period, std::function<void()> poll);
  ~ServedQueue();

  /// For node handles whose callbacks this thread is to serve.
  ros::CallbackQueueInterface* queue() { return &queue_; }

  void start();
  /// Stops the thread after its current callback. Later posts are discarded.
  void stop();

  /// Queues a task for the thread. Thread safe; never blocks.
  void post(std::function<void()> task);

  /// Changes the time between calls of `poll`. A shorter period counts from now, a longer one from the next call on.
  /// Only for the thread itself: its callbacks, its tasks and `poll`.
  /// @param period [s].
  void setPeriod(double period);

 private:
  using Clock = std::chrono::steady_clock;

  void run();

  Clock::duration period_;
  Clock::time_point next_poll_;
  const std::function<void()> poll_;
  ros::CallbackQueue queue_;
  std::atomic<bool> running_{false};
  std::thread thread_;
};

}  // namespace grinder
