#pragma once

#include "flute_grinder/motion/work_offsets.h"
#include "node/atomic_file.h"

#include <mutex>
#include <string>

namespace grinder {

/// The work offsets, kept on disk as by AtomicFile. Without a file they were never set and are 0. If the file cannot be
/// read they are unknown, and each remains so until it is set. Of offsets in a file that does not have it, it is
/// unknown what they were set for.
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

  /// Sets the offset of an axis. Returns once it is on the disk; if it throws, nothing has changed, or what() says that
  /// the file has. For one thread.
  /// @param axis Axis. @param offset its value is at most kMaxOffset in size.
  /// @throw AtomicFileError
  void set(int axis, const WorkOffset& offset);

 private:
  const AtomicFile file_;     ///< used by the constructor and set() only
  mutable std::mutex mutex_;  ///< guards the next two; held only to copy
  WorkOffsets offsets_;
  std::string error_;  ///< why the file could not be read; empty if it could
};

}  // namespace grinder
