#include "node/journal_writer.h"

#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace grinder {

namespace {

template <typename Task>
std::string errorOf(const Task& task) {
  try {
    task();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

/// State shared with the thread.
struct JournalWriter::Work {
  Work(std::string path, const std::string& owner) : journal(std::move(path), owner) {
    try {
      status.on_disk = journal.read().value_or(Progress{});
    } catch (const JournalDamaged& error) {
      status.error = status.damage = error.what();
    } catch (const JournalError& error) {
      status.error = unread = error.what();
      status.unread = true;
    }
  }

  void requireNothingUnread();
  void storePending();

  const Journal journal;  ///< used by the thread only
  std::string unread;     ///< why the file could not be read at the start; used by the thread only

  std::mutex mutex;  ///< guards everything below; held only to copy
  Status status;
  std::uint64_t writes = 0;
  std::optional<Progress> pending;
};

/// @throw JournalError as long as the file holds what was not read at the start.
void JournalWriter::Work::requireNothingUnread() {
  if (unread.empty()) return;
  if (journal.read()) throw JournalError(unread + "; it can be read now: start the grinder again");
  unread.clear();
}

void JournalWriter::Work::storePending() {
  std::unique_lock<std::mutex> lock(mutex);
  const Progress progress = std::move(*pending);
  pending.reset();
  const std::uint64_t number = writes;
  lock.unlock();
  const std::string error = errorOf([&] {
    requireNothingUnread();
    journal.write(progress);
  });
  lock.lock();
  if (error.empty()) {
    status.on_disk = progress;
    status.damage.clear();
    status.unread = false;
  }
  status.number = number;
  status.error = error;
}

JournalWriter::JournalWriter(std::string path, const std::string& owner)
    : work_(std::make_shared<Work>(std::move(path), owner)) {}

std::uint64_t JournalWriter::write(const Progress& progress) {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  if (!work_->pending) thread_.post([work = work_] { work->storePending(); });
  work_->pending = progress;
  return ++work_->writes;
}

JournalWriter::Status JournalWriter::status() const {
  const std::lock_guard<std::mutex> lock(work_->mutex);
  return work_->status;
}

}  // namespace grinder
