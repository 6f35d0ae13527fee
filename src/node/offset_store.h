#pragma once

#include "flute_grinder/motion/work_offsets.h"
#include "node/state_file.h"

#include <functional>
#include <mutex>
#include <string>

namespace grinder {

template <>
struct StateForm<WorkOffsets> {
  static constexpr const char* kKind = "file of work offsets";
  static constexpr const char* kComment =
      "The grinder's work offsets: machine position - work position; .nan is unknown.";
  static constexpr bool kInBackground = false;
  static void visit(StateFields& field, WorkOffsets& offsets);
};

/// The work offsets, the wheel and the tool, kept on disk by a StateFile. Without a file the offsets were never set and
/// are 0. If the file cannot be read, each offset is unknown until it is set.
class OffsetStore {
 public:
  /// Reads the file. Blocks on the disk.
  /// @param path, owner see StateFile.
  /// @throw StateFileOwned
  OffsetStore(std::string path, const std::string& owner);

  /// Thread safe; never waits for the disk.
  WorkOffsets offsets() const;

  /// Why the offsets of some axes are unknown, naming them; empty if all are known. Thread safe; never waits for the
  /// disk.
  std::string unknown() const;

  /// Changes the offsets. Called with the offsets on the disk and then with those in force, which may differ by
  /// changeAtOnce().
  using Change = std::function<void(WorkOffsets& offsets)>;

  /// Returns once the change is on the disk. If it throws, nothing has changed, unless what() says that the file has.
  /// For one thread.
  /// @param change must leave offsets of at most kMaxOffset in size.
  /// @throw StateFileError
  void change(const Change& change);

  /// Changes the offsets in force without waiting for the disk; the next change() also writes them. Thread safe.
  void changeAtOnce(const Change& change);

 private:
  StateFile<WorkOffsets> file_;
  const std::string error_;   ///< why the file could not be read; empty if it could
  mutable std::mutex mutex_;  ///< guards offsets_; held only to copy
  WorkOffsets offsets_;
};

}  // namespace grinder
