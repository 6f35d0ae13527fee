#pragma once

#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/job/tooth_pass.h"
#include "node/atomic_file.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// A journal that cannot be read or written; what() names the file and the reason.
using JournalError = AtomicFileError;

/// A journal that was read, and is not complete, or no journal.
using JournalDamaged = AtomicFileDamaged;

/// A journal in use by another process; what() names its node and process.
using JournalOwned = AtomicFileOwned;

/// How far a job has come.
struct Progress {
  std::string job_digest;            ///< see jobDigest(); empty if there has been no job
  std::string job_name;              ///< as given in the goal, for display
  std::string operation;             ///< as GrindJob::operationText()
  CutterGeometry cutter;             ///< of the job, for display
  std::vector<double> tooth_angles;  ///< of the job, for display [rad]
  bool finished = false;             ///< every pass is ground
  ToothPass next;                    ///< the first unfinished pass
  double x = 0;                      ///< reached in its stroke, or in the last one [m]
  std::string end;             ///< how it ended, for display; empty while it runs, and if this process ended first
  double feed_override = 1;    ///< at which it was left, fraction
  Wheel wheel;                 ///< as it was left
  Axes offset = Axes::Zero();  ///< with which the job began, see RunStart [m], A [rad]
  std::uint32_t mounting = 0;  ///< of the wheel with which the job began, see MountedWheel
  std::uint32_t clamping = 0;  ///< of the tool in the same way, see ClampedTool
  std::string tool_digest;     ///< as OffsetBasis::tool_digest
  int tool_operation = 0;      ///< as OffsetBasis::operation
};

/// Keeps the progress of a job on disk, see AtomicFile. Not thread safe; blocks on the disk.
class Journal {
 public:
  /// @param path, owner as for AtomicFile.
  /// @throw JournalOwned if another process owns it.
  Journal(std::string path, std::string owner);

  /// The last entry; nothing if there is no file.
  /// @throw JournalDamaged if the file is not a complete journal. @throw JournalError if it cannot be read.
  std::optional<Progress> read() const;

  /// As AtomicFile::write() with AtomicFile::settle(): an entry that has been written survives a power failure.
  /// @throw JournalError also if a value is not finite or out of range.
  void write(const Progress& progress) const;

 private:
  AtomicFile file_;
};

}  // namespace grinder
