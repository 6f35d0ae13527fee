#include "node/history.h"

#include "flute_grinder/base/replace_file.h"
#include "flute_grinder/record/record_file.h"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grinder {

namespace {

namespace fs = std::filesystem;

constexpr int kMaxWaiting = 16;         ///< most records that wait while the disk does not answer
constexpr std::size_t kMostNamed = 10;  ///< most names of skipped files in a message

/// Throws an error that names the skipped files. @param others at least one path. @throw std::runtime_error
[[noreturn]] void reportSkipped(const std::vector<std::string>& others) {
  std::string names;
  for (std::size_t i = 0; i < std::min(others.size(), kMostNamed); ++i) {
    names += (i == 0 ? "" : ", ") + fs::path(others[i]).filename().string();
  }
  if (others.size() > kMostNamed) names += " and " + std::to_string(others.size() - kMostNamed) + " more";
  throw std::runtime_error("named like records but no regular files, and skipped: " + names + "; move them elsewhere");
}

}  // namespace

/// The folder of records. Used only by the disk thread, except for the members guarded by the mutex.
struct History::Folder {
  Folder(fs::path folder_path, std::uint64_t size_limit) : path(std::move(folder_path)), limit(size_limit) {}

  /// Carries out an action on the disk, and notes its error. @param drops value of `dropped` when it was queued.
  template <typename Action>
  void attempt(std::uint64_t drops, const Action& action) {
    std::string failure;
    try {
      action();
    } catch (const std::exception& caught) {
      failure = "history " + path.string() + ": " + caught.what();
    }
    if (!failure.empty()) ROS_WARN_STREAM(failure);
    const std::lock_guard<std::mutex> lock(mutex);
    if (!failure.empty() || drops == dropped) error = failure;
  }

  void keep(double start, const std::string& text) const;
  void removeOldest() const;

  const fs::path path;
  const std::uint64_t limit;
  mutable std::mutex mutex;  ///< guards everything below; held only to copy
  int waiting = 0;
  std::uint64_t dropped = 0;  ///< records given up because too many waited
  std::string error;
};

/// Writes a record and removes old ones down to the limit. @throw std::exception if the record cannot be written or an
/// older one cannot be removed, or, after that, with the names of skipped files.
void History::Folder::keep(double start, const std::string& text) const {
  fs::create_directories(path);
  const fs::path file = path / recordName(start, recordFilesIn(path));
  writeFile(file, text);
  settleFile(file);
  removeOldest();
}

void History::Folder::removeOldest() const {
  RecordFiles found = recordFilesIn(path);
  std::vector<std::string>& files = found.records;
  files.insert(files.end(), found.unfinished.begin(), found.unfinished.end());
  std::sort(files.begin(), files.end());
  std::uint64_t size = 0;
  for (const std::string& file : files) size += fs::file_size(file);
  // The last one is the record just written.
  for (std::size_t i = 0; i + 1 < files.size() && size > limit; ++i) {
    size -= fs::file_size(files[i]);
    fs::remove(files[i]);
  }
  if (!found.others.empty()) reportSkipped(found.others);
}

History::History(const std::string& folder, std::uint64_t limit) : folder_(std::make_shared<Folder>(folder, limit)) {
  thread_.post([at = folder_] { at->attempt(0, [&] { fs::create_directories(at->path); }); });
}

void History::keep(double start, std::function<std::string()> text) {
  std::uint64_t drops = 0;
  {
    const std::lock_guard<std::mutex> lock(folder_->mutex);
    if (folder_->waiting >= kMaxWaiting) {
      // This error is not logged, because the log may be a file on the same disk.
      folder_->error = "history " + folder_->path.string() + ": the disk does not answer";
      ++folder_->dropped;
      return;
    }
    ++folder_->waiting;
    drops = folder_->dropped;
  }
  thread_.post([at = folder_, drops, start, text = std::move(text)] {
    at->attempt(drops, [&] { at->keep(start, text()); });
    const std::lock_guard<std::mutex> lock(at->mutex);
    --at->waiting;
  });
}

std::string History::error() const {
  const std::lock_guard<std::mutex> lock(folder_->mutex);
  return folder_->error;
}

}  // namespace grinder
