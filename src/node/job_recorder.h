#pragma once

#include "flute_grinder/record/job_record.h"
#include "node/history.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace grinder {

/// Gathers the records of the jobs that were announced, and gives each to the history once the job has ended and its
/// result is known, in either order. Not thread safe.
class JobRecorder {
 public:
  /// @param grinder name of the node. @param tolerances tolerances by which jobs are judged. @param history must
  /// outlive this object.
  JobRecorder(std::string grinder, MachineInfo machine, const Tolerances& tolerances, History& history);
  JobRecorder(const JobRecorder&) = delete;
  JobRecorder& operator=(const JobRecorder&) = delete;
  /// Keeps the records of jobs that have not ended, or whose result is missing, as far as they came.
  ~JobRecorder();

  /// @param number the loop's number for the job.
  void announce(std::uint64_t number, std::shared_ptr<JobRecord> record) { jobs_[number].record = std::move(record); }
  /// Drops a job that will not start.
  void withdraw(std::uint64_t number) { jobs_.erase(number); }
  /// The record of a job that was announced and has not ended.
  JobRecord& of(std::uint64_t number) { return *jobs_.at(number).record; }
  /// To be called when the last cycle of the job has been added.
  void end(std::uint64_t number);
  void conclude(std::uint64_t number, const JobConclusion& conclusion);

 private:
  struct Job {
    std::shared_ptr<JobRecord> record;
    bool ended = false, concluded = false;
  };

  void keepIfComplete(std::uint64_t number);
  void keep(const std::shared_ptr<const JobRecord>& record);

  const std::string grinder_;
  const MachineInfo machine_;
  const Tolerances tolerances_;
  History& history_;
  std::map<std::uint64_t, Job> jobs_;
};

}  // namespace grinder
