#pragma once

#include "flute_grinder/node/journal.h"

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

namespace flute_grinder {

/// Writes the newest progress into the journal by a thread of its own, so that nobody waits for the disk. For any
/// thread but the control thread.
class JournalKeeper {
 public:
  /// What has become of the orders.
  struct Told {
    Progress on_disk;          ///< what a restart would find
    std::uint64_t number = 0;  ///< of the last order that is carried out, written or failed; 0 before the first
    std::string error;         ///< of the last write, or of reading at the start; empty for none
  };

  /// Reads what is there, and starts the thread. Waits for the disk.
  /// @param path, owner as Journal's.
  /// @throw JournalOwned
  JournalKeeper(std::string path, const std::string& owner);

  /// Waits until what is ordered is carried out, but no longer than 5 s: then the disk is taken for dead, the file
  /// stays what it was or becomes the last one ordered, and the journal stays owned until the disk answers or the
  /// process ends.
  ~JournalKeeper();
  JournalKeeper(const JournalKeeper&) = delete;
  JournalKeeper& operator=(const JournalKeeper&) = delete;

  /// Orders the progress to be written, and returns at once. While the disk is busy the newest order takes the place of
  /// the one that waits.
  /// @return the order's number, counted from 1.
  std::uint64_t write(const Progress& progress);

  /// As of now. Waits for nothing but a copy.
  Told told() const;

 private:
  struct Work;

  std::shared_ptr<Work> work_;  ///< with the thread, which outlives this where the disk is dead
  std::thread thread_;
};

}  // namespace flute_grinder
