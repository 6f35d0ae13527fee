#pragma once

#include "flute_grinder/motion/work_offsets.h"
#include "node/atomic_file.h"

#include <functional>
#include <mutex>
#include <string>

namespace grinder {

/// The work offsets and what they depend on, kept on disk as by AtomicFile. Without a file they were never set and are
/// 0. If the file cannot be read they are unknown, and each remains so until it is set.
class OffsetStore {
 public:
  /// Reads the file. Blocks on the disk.
  /// @param path, owner as for AtomicFile.
  /// @throw AtomicFileOwned
  OffsetStore(std::string path, std::string owner);

  /// Thread safe; never waits for the disk.
  WorkOffsets offsets() const;

  /// Why the offsets of some axes are unknown, naming them; empty if all are known. Thread safe; never waits for the
  /// disk.
  std::string unknown() const;

  /// Called with what is on the disk and then with what is in force, which may differ by changeAtOnce().
  using Change = std::function<void(WorkOffsets& offsets)>;

  /// Returns once the change is on the disk; if it throws, nothing has changed, or what() says that the file has. For
  /// one thread.
  /// @param change leaves offsets of at most kMaxOffset in size.
  /// @throw AtomicFileError
  void change(const Change& change);

  /// Changes what is in force without waiting for the disk, which has it with the next change(). Thread safe.
  void changeAtOnce(const Change& change);

 private:
  const AtomicFile file_;     ///< used by the constructor and change() only
  mutable std::mutex mutex_;  ///< guards the next two; held only to copy
  WorkOffsets offsets_;
  std::string error_;  ///< why the file could not be read; empty if it could
};

}  // namespace grinder
