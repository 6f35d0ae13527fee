#pragma once

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/messages/json.h"
#include "flute_grinder/motion/setpoint.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grinder {

/// What a file is, by how it begins.
enum class FileKind {
  kOther,   ///< a job, for instance
  kRecord,  ///< JSON, as the grinder keeps of every job
  kTable,   ///< points of a curve, from `grind table`
  kPlan,    ///< setpoints, from `grind plan`
  kRun,     ///< setpoints with the positions read, from `grind run`
  kBag      ///< of the grinder
};
/// @throw FileError if it cannot be read, JobFileError if it is no regular file.
FileKind kindOf(const std::string& path);

/// A setpoint as a file has it, or a point of a table.
struct RunRow {
  Setpoint setpoint;
  Axes actual = Axes::Zero();  ///< read one cycle before; 0 in a table and in a plan [m], A [rad]
  double time = 0;             ///< since the start of the job; 0 in a table [s]
  double cycle_period = 0;     ///< as measured; only in a bag [s]
};
using RowVisitor = std::function<void(const RunRow&)>;

/// All rows of a file together.
struct RowSummary {
  std::uint64_t count = 0;
  std::uint64_t missing = 0;  ///< cycles between them
  std::uint64_t first_cycle = 0;
  Axes first = Axes::Zero();             ///< commanded first [m], A [rad]
  double begin = 0, end = 0;             ///< when the first and the last were [s]
  double odd_error = 0, even_error = 0;  ///< maximum at the points of the curve [rad]
  std::optional<ToothPass> worst;        ///< the stroke with the maximum error; nothing without a point of the curve
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x;  ///< of these points [m]
};

/// What `~state` says that a report shows.
struct StateChange {
  double time = 0;  ///< since the start of the job [s]
  std::string state;
  bool held = false;  ///< the job
  std::string reason;
  double feed_override = 1;  ///< fraction
  ToothPass pass;
};

/// The worst of a status in /diagnostics.
struct WorstStatus {
  int level = -1;
  std::string message;
  int count = 0;  ///< of messages with this level
};

/// A job in a file with rows: a table, a plan, a run or a bag.
class RunFile {
 public:
  /// @param job which one of a bag, from 1; 0 for the last.
  /// @throw FileError naming file, line or cycle, if it cannot be read, is none of these, has fewer than three rows, or
  ///        not this job. JobFileError if it is no regular file.
  static std::unique_ptr<RunFile> open(const std::string& path, int job);

  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;
  virtual ~RunFile() = default;

  /// The rows, in ascending order of their cycles; as often as called. @throw FileError
  virtual void visit(const RowVisitor& visitor) const = 0;

  FileKind kind() const noexcept { return kind_; }
  /// Whether it has the positions that the drive read.
  bool hasActual() const noexcept { return kind_ == FileKind::kRun || kind_ == FileKind::kBag; }
  /// Control cycle; 0 of a table [s].
  double period() const noexcept { return period_; }
  const RowSummary& summary() const noexcept { return summary_; }
  /// The job, if the file has it.
  const std::optional<ValidJob>& job() const noexcept { return job_; }
  /// Of a relief in a bag: for each operation ahead of it, the jobs of the bag that ground it on this cutter: the last
  /// that began before, and those that continued it. Empty if one of them is not there, and for a file without a job.
  const std::vector<std::vector<int>>& before() const noexcept { return before_; }
  /// Which of a bag's jobs, for the reader; else empty.
  const std::string& place() const noexcept { return place_; }
  /// What else the file says of the job, in the keys of a record.
  const Json& head() const noexcept { return head_; }
  /// From that which was in force when the job began to the first after its end in which it is not held.
  const std::vector<StateChange>& states() const noexcept { return states_; }
  /// Of the whole bag, by names.
  const std::vector<std::pair<std::string, WorstStatus>>& diagnostics() const noexcept { return diagnostics_; }

 protected:
  RunFile(std::string path, FileKind kind) : path_(std::move(path)), kind_(kind) {}

  /// Adds a row to the summary. @throw FileError if its cycle does not follow, or a number is not finite.
  void summarise(const RunRow& row);
  /// Forgets what was summarised.
  void restart();
  /// @throw FileError if there are too few rows.
  void finish() const;
  [[noreturn]] void fail(const std::string& reason) const;

  const std::string path_;
  double period_ = 0;
  std::optional<ValidJob> job_;
  std::vector<std::vector<int>> before_;
  std::string place_;
  Json head_ = Json::object();
  std::vector<StateChange> states_;
  std::vector<std::pair<std::string, WorstStatus>> diagnostics_;

 private:
  const FileKind kind_;
  std::int64_t last_cycle_ = -1;  ///< cycle 0 is the start position of a job
  RowSummary summary_;
};

}  // namespace grinder
