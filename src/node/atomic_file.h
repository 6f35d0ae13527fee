#pragma once

#include "flute_grinder/job/escaped.h"

#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

namespace grinder {

/// An atomic file that cannot be read or written; what() names it and the reason, and is escaped(): a damaged file may
/// have anything.
class AtomicFileError : public std::runtime_error {
 public:
  explicit AtomicFileError(const std::string& text) : std::runtime_error(escaped(text)) {}
};

/// An atomic file that was read, and is not as it was written.
class AtomicFileDamaged : public AtomicFileError {
 public:
  using AtomicFileError::AtomicFileError;
};

/// An atomic file in use by another process; what() names its node and process.
class AtomicFileOwned : public AtomicFileError {
 public:
  using AtomicFileError::AtomicFileError;
};

/// Keeps a text on disk, so that it survives a crash and a power failure. The file is always either the old or the new
/// version, complete; a damaged or modified file is refused. Only one AtomicFile on the computer can own it at a time,
/// by a lock on a file beside it with the suffix `.lock`, which is never removed. Not thread safe; blocks on the disk.
class AtomicFile {
 public:
  /// Owns the file for the lifetime of the object. If the path cannot be used (it is a folder, say), read() and write()
  /// try again and throw the reason.
  /// @param kind what the file is, for messages, e.g. "journal".
  /// @param path the file; missing folders are created, symbolic links are followed.
  /// @param owner the resolved name of the node.
  /// @throw AtomicFileOwned if another process owns it.
  AtomicFile(std::string kind, std::string path, std::string owner);
  ~AtomicFile();

  /// The text written last; nothing if there is no file.
  /// @throw AtomicFileDamaged if the file is not complete, as write() wrote it. @throw AtomicFileError if it cannot be
  /// read.
  std::optional<std::string> read() const;

  /// Returns once the text is on the disk. After a power failure the file holds the new or the old text, and the new
  /// one for certain once settle() has returned.
  /// @throw AtomicFileError
  void write(const std::string& text) const;
  /// Returns once the file's name on the disk stands for the text written last.
  /// @throw AtomicFileError
  void settle() const;

  /// Rethrows any other error of an action as an Error that names the file.
  template <typename Error = AtomicFileError, typename Action>
  auto named(const Action& action) const {
    try {
      return action();
    } catch (const AtomicFileError&) {
      throw;
    } catch (const std::exception& error) {
      throw Error(kind_ + " " + path_ + ": " + error.what());
    }
  }

 private:
  class File;

  void acquire() const;

  std::string kind_, path_, owner_;
  mutable std::string file_;            ///< the path without symbolic links, once it is owned
  mutable std::unique_ptr<File> lock_;  ///< held while not null
};

/// Throws std::runtime_error for a value out of range, naming key, value and what is allowed.
template <typename Value>
void requireAllowed(bool good, const std::string& key, const Value& value, const std::string& allowed) {
  if (good) return;
  std::ostringstream text;
  text << key << " = " << value << "; allowed: " << allowed;
  throw std::runtime_error(text.str());
}

}  // namespace grinder
