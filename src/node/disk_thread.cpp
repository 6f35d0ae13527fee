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
  std::condition_variable changed;
  std::deque<std::function<void()>> tasks;
  bool closing = false, closed = false;
};

void DiskThread::Work::run() {
  std::unique_lock<std::mutex> lock(mutex);
  while (true) {
    changed.wait(lock, [&] { return !tasks.empty() || closing; });
    if (tasks.empty()) break;
    std::function<void()> task = std::move(tasks.front());
    tasks.pop_front();
    lock.unlock();
    task();
    task = nullptr;
    lock.lock();
  }
  closed = true;
  changed.notify_all();
}

DiskThread::DiskThread() : work_(std::make_shared<Work>()), thread_([work = work_] { work->run(); }) {}

DiskThread::~DiskThread() {
  std::unique_lock<std::mutex> lock(work_->mutex);
  work_->closing = true;
  work_->changed.notify_all();
  const bool closed = work_->changed.wait_for(lock, kCloseTimeout, [&] { return work_->closed; });
  lock.unlock();
  if (closed) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void DiskThread::post(std::function<void()> task) {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  work_->tasks.push_back(std::move(task));
  work_->changed.notify_all();
}

}  // namespace grinder
