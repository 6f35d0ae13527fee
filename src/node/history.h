#pragma once

#include "node/disk_thread.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace grinder {

/// Keeps the records of the last jobs in a folder, one file per record, written atomically. A thread of its own
/// waits for the disk. Thread safe; not for the control thread.
class History {
 public:
  /// Makes the folder, or notes why this fails; returns at once.
  /// @param folder folder for the records of one grinder.
  /// @param limit maximum size of all records together [bytes]. The oldest are removed first; the last one stays
  ///        whatever its size. Only files with the name of a record are removed.
  History(const std::string& folder, std::uint64_t limit);

  /// Queues a record to be written, and returns at once. A record that cannot be written is given up.
  /// @param start start of the job since the epoch [s], by a clock that may be wrong.
  /// @param text makes the record's text; called once, in this object's thread.
  void keep(double start, std::function<std::string()> text);

  /// Why the folder could not be made or the last record could not be written; empty for no error. Never waits for the
  /// disk.
  std::string error() const;

 private:
  struct Folder;

  std::shared_ptr<Folder> folder_;
  DiskThread thread_;
};

}  // namespace grinder
