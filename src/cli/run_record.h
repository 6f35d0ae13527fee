#pragma once

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/motion/setpoint.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace flute_grinder {

/// The kind of a file by how it begins.
enum class FileKind { kJob, kRunCsv, kBag };
/// @throw FileError if it cannot be read.
FileKind kindOf(const std::string& path);

/// Takes a setpoint of a record, with the position that was read one cycle before [m], A [rad].
using RecordVisitor = std::function<void(const Setpoint& setpoint, const Axes& actual)>;

/// One of the jobs in a bag.
class BagRecord {
 public:
  /// @param run which job, from 1; 0 for the last.
  /// @throw FileError if the bag cannot be read, or does not have the job.
  BagRecord(const std::string& path, int run);

  /// Its name for the reader.
  const std::string& name() const { return name_; }
  /// From its goal; nothing if the bag has no goal.
  const std::optional<GrindJob>& job() const { return job_; }
  /// Its setpoints in order. @throw FileError
  void visit(const RecordVisitor& visitor) const;

 private:
  const std::string path_;
  std::string goal_id_, name_;
  std::optional<GrindJob> job_;
};

/// The setpoints of a CSV file of `grind run`, in order. @throw FileError with the line.
void visitRunCsv(const std::string& path, const RecordVisitor& visitor);

}  // namespace flute_grinder
