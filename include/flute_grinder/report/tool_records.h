#pragma once

#include "flute_grinder/geometry/run_strokes.h"
#include "flute_grinder/record/record_file.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Where the wheel was in a run of a job: the record that began it, and those that continued it. @param job with its
/// laws.
/// @param before the cutter as the operations ahead of a relief ground it; nothing: as they are planned.
/// @throw std::exception, with the reason, if a record does not have it.
RunStrokes groundStrokes(const ValidJob& job, const std::vector<Record>& records,
                         std::optional<GroundCutter> before = std::nullopt);

/// The records of one tool, by the operations of its job.
class ToolRecords {
 public:
  /// What the records say of an operation.
  struct Operation {
    GrindJob asked;
    std::optional<ValidJob> job;     ///< with its laws; nothing if the operation is not in the records
    std::vector<std::string> files;  ///< names of the records: of the run that began it, and of those that continued it
    std::vector<Record> records;     ///< of these; none if the operation is not in the records

    /// Strokes of the job that none of the records has ground to its end; none without a record.
    std::vector<ToothPass> missing() const;
    /// In words.
    std::string name() const { return rowOf(asked.process.kind).words; }
  };

  /// Looks for the other operations among the records of the same folder: those ahead of the record, of the same job,
  /// with no other tool of it in between, and those behind it.
  /// @param path of one of the tool's records. @throw FileError if it is none; JobFileError, InvalidJob or ReasonError
  /// if its job is none.
  explicit ToolRecords(const std::string& path);

  /// In the order of the job.
  const std::vector<Operation>& operations() const noexcept { return operations_; }
  /// The last one that the records have.
  const Operation& last() const { return operations_[last_]; }
  /// Whether each operation is in the records.
  bool isWhole() const;

  /// The strokes of the last operation, on the cutter as those ahead of it ground it; where one of these is not in the
  /// records, they are taken as planned. @throw as groundStrokes().
  RunStrokes strokes() const;

 private:
  std::vector<Operation> operations_;
  std::size_t last_ = 0;
};

}  // namespace grinder
