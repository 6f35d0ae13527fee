#pragma once

#include <functional>
#include <future>
#include <memory>
#include <thread>

namespace grinder {

/// A thread that runs tasks that block on the disk, one after the other. Thread safe; no call waits for a task.
class DiskThread {
 public:
  DiskThread();
  /// Waits up to 5 s for the tasks that were posted. After that the disk is presumed dead, and the thread is detached,
  /// with all that its tasks hold.
  ~DiskThread();

  /// Queues a task and returns at once. @param task must not throw, and must own all it uses, because it may outlive
  /// everything else.
  void post(std::function<void()> task);

 private:
  struct Work;

  std::shared_ptr<Work> work_;  ///< shared with the thread, which outlives this object if the disk is dead
  std::future<void> ended_;
  std::thread thread_;
};

}  // namespace grinder
