#pragma once

#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/core/grind_job.h"

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace flute_grinder {

/// A journal that cannot be read or written; what() names the file and the reason.
class JournalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A journal in use by another process; what() names its node and process.
class JournalOwned : public JournalError {
 public:
  using JournalError::JournalError;
};

/// How far a job has come.
struct Progress {
  std::string job_digest;            ///< see jobDigest(); empty if there has been no job
  std::string job_name;              ///< as given in the goal, for display
  CutterGeometry cutter;             ///< of the job, for display
  std::vector<double> tooth_angles;  ///< of the job, for display [rad]
  bool finished = false;             ///< every pass is ground
  ToothPass next;                    ///< the first unfinished pass
  double x = 0;                      ///< reached in its stroke, or in the last one [m]
  Wheel wheel;                       ///< as it was left
};

/// Keeps the progress of a job on disk, so that it survives a crash and a power failure. The file is always either the
/// old or the new version, complete; a damaged or modified file is refused. Only one Journal on the computer can own it
/// at a time, by a lock on a file beside it with the suffix `.lock`, which is never removed. Not thread safe; blocks on
/// the disk.
class Journal {
 public:
  /// Owns the file for the lifetime of the object. If the path cannot be used (it is a folder, say), read() and write()
  /// try again and throw the reason.
  /// @param path the file; missing folders are created, symbolic links are followed.
  /// @param owner the resolved name of the node.
  /// @throw JournalOwned if another process owns it.
  Journal(std::string path, std::string owner);
  ~Journal();

  /// The last entry; nothing if there is no file.
  /// @throw JournalError if the file is not a complete journal.
  std::optional<Progress> read() const;

  /// Returns once the progress is safe on the disk.
  /// @throw JournalError also if a value is not finite or out of range.
  void write(const Progress& progress) const;

 private:
  class File;

  void acquire() const;

  std::string path_, owner_;
  mutable std::string file_;            ///< the path without symbolic links, once it is owned
  mutable std::unique_ptr<File> lock_;  ///< held while not null
};

}  // namespace flute_grinder
