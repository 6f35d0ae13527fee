#pragma once

#include "flute_grinder/record/record_file.h"
#include "flute_grinder/tool/run_strokes.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The records of one tool, by the operations of its job.
class ToolRecords {
 public:
  /// An operation, with its records.
  struct Operation {
    GrindJob asked;
    std::optional<ValidJob> job;     ///< job with its laws; nothing if the operation is not in the records
    std::vector<std::string> files;  ///< names of the records, of the run that began the job and of its continuations
    std::vector<Record> records;     ///< the records; none if the operation is not in the records

    /// The strokes of the job that no record has ground to the end; none without a record.
    std::vector<ToothPass> missing() const;
    /// The name of the operation in words.
    std::string name() const { return rowOf(asked.process().kind).words; }
  };

  /// Finds the tool's other operations among the records of the same folder: before and after the given record, of the
  /// same job, with no other tool of that job in between.
  /// @param path one of the tool's records. @throw FileError if it is not a record; InvalidJob or ReasonError if
  /// its job is not valid.
  explicit ToolRecords(const std::string& path);

  /// The operations in the order of the job.
  const std::vector<Operation>& operations() const noexcept { return operations_; }
  /// The last operation in the records.
  const Operation& last() const { return operations_[last_]; }
  /// Of the record that was named.
  const Operation& own() const { return operations_[own_]; }

  /// The folder of the records.
  const std::string& folder() const noexcept { return folder_; }

  /// The strokes of an operation, on the cutter ground by the operations ahead of it; if one of these is not in the
  /// records, all are taken as planned. @param operation one of operations() that has records.
  /// @throw std::exception with the reason, if a record lacks the path of the wheel.
  RunStrokes strokes(const Operation& operation) const;

 private:
  const std::string folder_;
  std::vector<Operation> operations_;
  std::size_t own_ = 0, last_ = 0;
};

}  // namespace grinder
