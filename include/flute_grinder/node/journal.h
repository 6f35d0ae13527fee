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

/// A journal that another one has; what() names its node and process.
class JournalOwned : public JournalError {
 public:
  using JournalError::JournalError;
};

/// How far a job has come.
struct Progress {
  std::string job_digest;            ///< as jobDigest() gives it; empty where there has been no job
  std::string job_name;              ///< as the goal named it, for people
  CutterGeometry cutter;             ///< of the job, for people
  std::vector<double> tooth_angles;  ///< of the job, for people [rad]
  bool finished = false;             ///< every pass is ground
  ToothPass next;                    ///< the first pass that is not finished
  double x = 0;                      ///< where its stroke has come to, or the last one's [m]
  Wheel wheel;                       ///< where it was left
};

/// Keeps the progress of a job on disk, so that it outlives the process and the power: the file is always either the
/// old one or the new one, whole, and what was damaged or changed since is refused. It belongs to one Journal at a time
/// in all processes of the computer, by a lock on the file beside it that is named `.lock`, and that stays. For one
/// thread at a time, which it lets wait for the disk.
class Journal {
 public:
  /// Takes the file for this process until the end of the object's life. Where the path cannot be used, as that of a
  /// folder, read() and write() tell why, each trying anew.
  /// @param path the file; folders above it are made as needed, symbolic links are followed.
  /// @param owner the resolved name of the node.
  /// @throw JournalOwned where it is taken.
  Journal(std::string path, std::string owner);
  ~Journal();

  /// What was written last; nothing if there is no file.
  /// @throw JournalError where there is a file that is not a whole journal.
  std::optional<Progress> read() const;

  /// Returns once the progress is safe on the disk.
  /// @throw JournalError also for figures that are not finite or out of range.
  void write(const Progress& progress) const;

 private:
  class File;

  void own() const;

  std::string path_, owner_;
  mutable std::string file_;            ///< the path without symbolic links, once it is owned
  mutable std::unique_ptr<File> lock_;  ///< held while there is one
};

}  // namespace flute_grinder
