#pragma once

#include <ros/callback_queue.h>

#include <atomic>
#include <functional>
#include <thread>

namespace flute_grinder {

/// A callback queue with the one thread that serves it: what is registered with it, and what poll() uses, has that
/// thread as its owner and needs no lock.
class ServedQueue {
 public:
  ServedQueue();
  /// @param period how often `poll` is called between the callbacks [s].
  ServedQueue(double period, std::function<void()> poll);
  ServedQueue(const ServedQueue&) = delete;
  ServedQueue& operator=(const ServedQueue&) = delete;
  ~ServedQueue();

  /// For node handles whose callbacks belong to this thread.
  ros::CallbackQueueInterface* queue() { return &queue_; }

  void start();
  /// Ends the thread after the callback that it is in. What is called later is not carried out.
  void stop();

  /// Has the thread carry something out, in the order of the queue. Thread safe; waits for nothing.
  void call(std::function<void()> what);

 private:
  void run();

  const double period_;
  const std::function<void()> poll_;
  ros::CallbackQueue queue_;
  std::atomic<bool> running_{false};
  std::thread thread_;
};

}  // namespace flute_grinder
