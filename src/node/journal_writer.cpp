#include "flute_grinder/node/journal_writer.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace flute_grinder {

namespace {

constexpr std::chrono::seconds kCloseTimeout(5);

}  // namespace

/// State shared with the thread.
struct JournalWriter::Work {
  Work(std::string path, const std::string& owner) : journal(std::move(path), owner) {
    try {
      status.on_disk = journal.read().value_or(Progress{});
    } catch (const JournalError& error) {
      status.error = error.what();
    }
  }

  void run();
  void store(const Progress& progress, std::uint64_t number);

  const Journal journal;  ///< used by the thread only

  std::mutex mutex;  ///< guards everything below; held only to copy
  std::condition_variable changed;
  Status status;
  std::uint64_t writes = 0;
  std::optional<Progress> pending;
  bool closing = false, closed = false;
};

void JournalWriter::Work::run() {
  std::unique_lock<std::mutex> lock(mutex);
  while (true) {
    changed.wait(lock, [&] { return pending || closing; });
    if (!pending) break;
    const Progress progress = std::move(*pending);
    pending.reset();
    const std::uint64_t number = writes;
    lock.unlock();
    store(progress, number);
    lock.lock();
  }
  closed = true;
  changed.notify_all();
}

void JournalWriter::Work::store(const Progress& progress, std::uint64_t number) {
  std::string error;
  try {
    journal.write(progress);
  } catch (const JournalError& failure) {
    error = failure.what();
  }
  const std::lock_guard<std::mutex> lock(mutex);
  if (error.empty()) status.on_disk = progress;
  status.number = number;
  status.error = std::move(error);
}

JournalWriter::JournalWriter(std::string path, const std::string& owner)
    : work_(std::make_shared<Work>(std::move(path), owner)), thread_([work = work_] { work->run(); }) {}

JournalWriter::~JournalWriter() {
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

std::uint64_t JournalWriter::write(const Progress& progress) {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  work_->pending = progress;
  work_->changed.notify_all();
  return ++work_->writes;
}

JournalWriter::Status JournalWriter::status() const {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  return work_->status;
}

}  // namespace flute_grinder
