#pragma once

#include "node/disk_thread.h"
#include "node/journal.h"

#include <cstdint>
#include <memory>
#include <string>

namespace grinder {

/// Writes the latest progress to the journal in its own thread, so that nothing else waits for the disk. Thread safe;
/// not for the control thread.
class JournalWriter {
 public:
  /// Outcome of the writes.
  struct Status {
    Progress on_disk;          ///< what a restart would find
    std::uint64_t number = 0;  ///< of the last write that succeeded or failed; 0 before the first
    std::string error;         ///< of the last write, or of the initial read; empty if none
    std::string damage;        ///< of the file as it was read, until it is replaced; empty if none
    bool unread = false;       ///< the file could not be read at the start, and has not been replaced
  };

  /// Reads the journal and starts the thread, which waits at the end as DiskThread does: if the disk is dead by then,
  /// the file holds either its old contents or the last write, and the journal stays owned until the disk answers or
  /// the process ends. Blocks on the disk.
  /// @param path, owner as for Journal.
  /// @throw JournalOwned
  JournalWriter(std::string path, const std::string& owner);

  /// Queues the progress to be written, and returns at once. While the disk is busy, a new write replaces the pending
  /// one. If the file could not be read, no write succeeds as long as there may be one: it may hold an unfinished job.
  /// @return the number of this write, from 1.
  std::uint64_t write(const Progress& progress);

  /// The current outcome. Never waits for the disk.
  Status status() const;

 private:
  struct Work;

  std::shared_ptr<Work> work_;
  DiskThread thread_;
};

}  // namespace grinder
