#include "flute_grinder/node/history.h"

#include "flute_grinder/core/record_name.h"
#include "flute_grinder/geometry/replace_file.h"

#include <ros/console.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

namespace flute_grinder {

namespace {

namespace fs = std::filesystem;

constexpr int kMostWaiting = 16;  ///< records, while the disk does not answer

}  // namespace

/// Used by the thread, but for what it tells.
struct History::Folder {
  Folder(fs::path folder_path, std::uint64_t size_limit) : path(std::move(folder_path)), limit(size_limit) {}

  /// Carries out an action on the disk, and notes its error.
  template <typename Action>
  void attempt(const Action& action) {
    std::string failure;
    try {
      action();
    } catch (const std::exception& caught) {
      failure = "history " + path.string() + ": " + caught.what();
    }
    note(failure);
  }

  void note(const std::string& failure) {
    if (!failure.empty()) ROS_WARN_STREAM(failure);
    const std::lock_guard<std::mutex> lock(mutex);
    error = failure;
  }

  void removeOldest() const;

  const fs::path path;
  const std::uint64_t limit;
  std::atomic<int> waiting{0};
  mutable std::mutex mutex;  ///< guards `error`; held only to copy
  std::string error;
};

void History::Folder::removeOldest() const {
  std::vector<fs::path> files;
  std::uint64_t size = 0;
  for (const auto& entry : fs::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    if (!isRecordName(name) && !isUnfinishedRecordName(name)) continue;
    files.push_back(entry.path());
    size += entry.file_size();
  }
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i + 1 < files.size() && size > limit; ++i) {
    size -= fs::file_size(files[i]);
    fs::remove(files[i]);
  }
}

History::History(const std::string& folder, std::uint64_t limit) : folder_(std::make_shared<Folder>(folder, limit)) {
  thread_.post([at = folder_] { at->attempt([&] { fs::create_directories(at->path); }); });
}

void History::keep(const std::string& name, std::function<std::string()> text) {
  if (folder_->waiting >= kMostWaiting)
    return folder_->note("history " + folder_->path.string() + ": the disk does not answer");
  ++folder_->waiting;
  thread_.post([at = folder_, name, text = std::move(text)] {
    at->attempt([&] {
      fs::create_directories(at->path);
      writeFile(at->path / name, text());
      at->removeOldest();
    });
    --at->waiting;
  });
}

std::string History::error() const {
  const std::lock_guard<std::mutex> lock(folder_->mutex);
  return folder_->error;
}

}  // namespace flute_grinder
