#pragma once

#include "flute_grinder/core/grind_job.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace flute_grinder {

/// A journal that cannot be read or written; what() names the file and the reason.
class JournalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How far a job has come.
struct Progress {
  std::string job_digest;  ///< as jobDigest() gives it
  bool finished = false;   ///< every pass is ground
  ToothPass next;          ///< the first pass that is not finished
  double x = 0;            ///< where its stroke has come to, or the last one's [m]
};

/// Keeps the progress of a job on disk, so that it outlives the process and the power: the file is always either the
/// old one or the new one, whole. Not for the control thread.
class Journal {
 public:
  /// @param path the file; folders above it are made as needed.
  explicit Journal(std::string path) : path_(std::move(path)) {}

  /// What was written last; nothing if there is no file.
  /// @throw JournalError
  std::optional<Progress> read() const;

  /// Returns once the progress is safe on the disk.
  /// @throw JournalError
  void write(const Progress& progress) const;

 private:
  std::string path_;
};

}  // namespace flute_grinder
