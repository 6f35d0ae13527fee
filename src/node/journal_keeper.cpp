#include "flute_grinder/node/journal_keeper.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace flute_grinder {

namespace {

constexpr std::chrono::seconds kPatience(5);

}  // namespace

/// What the thread works on.
struct JournalKeeper::Work {
  Work(std::string path, const std::string& owner) : journal(std::move(path), owner) {
    try {
      told.on_disk = journal.read().value_or(Progress{});
    } catch (const JournalError& error) {
      told.error = error.what();
    }
  }

  void run();
  void carryOut(const Progress& progress, std::uint64_t number);

  const Journal journal;  ///< the thread's

  std::mutex mutex;  ///< guards all below; held for no longer than copying takes
  std::condition_variable changed;
  Told told;
  std::uint64_t orders = 0;
  std::optional<Progress> waiting;
  bool closing = false, closed = false;
};

void JournalKeeper::Work::run() {
  std::unique_lock<std::mutex> lock(mutex);
  while (true) {
    changed.wait(lock, [&] { return waiting || closing; });
    if (!waiting) break;
    const Progress progress = std::move(*waiting);
    waiting.reset();
    const std::uint64_t number = orders;
    lock.unlock();
    carryOut(progress, number);
    lock.lock();
  }
  closed = true;
  changed.notify_all();
}

void JournalKeeper::Work::carryOut(const Progress& progress, std::uint64_t number) {
  std::string error;
  try {
    journal.write(progress);
  } catch (const JournalError& trouble) {
    error = trouble.what();
  }
  const std::lock_guard<std::mutex> lock(mutex);
  if (error.empty()) told.on_disk = progress;
  told.number = number;
  told.error = std::move(error);
}

JournalKeeper::JournalKeeper(std::string path, const std::string& owner)
    : work_(std::make_shared<Work>(std::move(path), owner)), thread_([work = work_] { work->run(); }) {}

JournalKeeper::~JournalKeeper() {
  std::unique_lock<std::mutex> lock(work_->mutex);
  work_->closing = true;
  work_->changed.notify_all();
  const bool closed = work_->changed.wait_for(lock, kPatience, [&] { return work_->closed; });
  lock.unlock();
  if (closed) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

std::uint64_t JournalKeeper::write(const Progress& progress) {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  work_->waiting = progress;
  work_->changed.notify_all();
  return ++work_->orders;
}

JournalKeeper::Told JournalKeeper::told() const {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  return work_->told;
}

}  // namespace flute_grinder
