#include "node/disk_thread.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

namespace grinder {

namespace {

constexpr std::chrono::seconds kCloseTimeout(5);

}  // namespace

/// State shared with the thread.
struct DiskThread::Work {
  void run();

  std::mutex mutex;  ///< guards everything below; never held during a task
  std::condition_variable posted;
  std::deque<std::function<void()>> tasks;  ///< an empty one ends the thread
};

void DiskThread::Work::run() {
  while (true) {
    std::unique_lock<std::mutex> lock(mutex);
    posted.wait(lock, [&] { return !tasks.empty(); });
    const std::function<void()> task = std::move(tasks.front());
    tasks.pop_front();
    lock.unlock();
    if (!task) return;
    task();
  }
}

DiskThread::DiskThread() : work_(std::make_shared<Work>()) {
  std::packaged_task<void()> run([work = work_] { work->run(); });
  ended_ = run.get_future();
  thread_ = std::thread(std::move(run));
}

DiskThread::~DiskThread() {
  post(nullptr);
  if (ended_.wait_for(kCloseTimeout) == std::future_status::ready) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void DiskThread::post(std::function<void()> task) {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  work_->tasks.push_back(std::move(task));
  work_->posted.notify_one();
}

}  // namespace grinder
