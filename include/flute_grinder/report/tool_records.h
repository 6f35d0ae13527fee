#pragma once

#include "flute_grinder/geometry/run_strokes.h"
#include "flute_grinder/record/record_file.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

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
  /// Of the record that was named.
  const Operation& own() const { return operations_[own_]; }

  /// The strokes of an operation, on the cutter as those ahead of it ground it; where one of these is not in the
  /// records, they are taken as planned. @param operation of operations(), in the records. @throw std::exception, with
  /// the reason, if a record does not have its strokes.
  RunStrokes strokes(const Operation& operation) const;

 private:
  std::vector<Operation> operations_;
  std::size_t own_ = 0, last_ = 0;
};

}  // namespace grinder
