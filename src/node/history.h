#pragma once

#include "node/disk_thread.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace grinder {

/// Keeps the records of the last jobs in a folder, one file for each, written in one step. A thread of its own waits
/// for the disk. Thread safe; not for the control thread.
class History {
 public:
  /// Makes the folder, or notes why that is not possible; returns at once.
  /// @param folder for the records of one grinder.
  /// @param limit maximum size of all records together [bytes]: those written first are removed first, and the last
  ///        one stays whatever its size. Nothing is removed but what has the name of a record.
  History(const std::string& folder, std::uint64_t limit);

  /// Queues a record to be written, and returns at once. What cannot be written is given up.
  /// @param start of the job, since the epoch [s], by a clock that may be wrong.
  /// @param text called once, in this object's thread.
  void keep(double start, std::function<std::string()> text);

  /// Why the folder could not be made or the last record not be written; empty if nothing is wrong. Never waits for the
  /// disk.
  std::string error() const;

 private:
  struct Folder;

  std::shared_ptr<Folder> folder_;
  DiskThread thread_;
};

}  // namespace grinder
