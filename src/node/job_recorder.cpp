#include "node/job_recorder.h"

#include <utility>

namespace grinder {

JobRecorder::JobRecorder(std::string grinder, MachineInfo machine, const Tolerances& tolerances, History& history)
    : grinder_(std::move(grinder)), machine_(std::move(machine)), tolerances_(tolerances), history_(history) {}

JobRecorder::~JobRecorder() {
  for (const auto& entry : jobs_) keep(entry.second.record);
}

void JobRecorder::end(std::uint64_t number) {
  jobs_.at(number).ended = true;
  keepIfComplete(number);
}

void JobRecorder::conclude(std::uint64_t number, const JobConclusion& conclusion) {
  const auto job = jobs_.find(number);
  if (job == jobs_.end()) return;
  job->second.record->conclude(conclusion);
  job->second.concluded = true;
  keepIfComplete(number);
}

void JobRecorder::keepIfComplete(std::uint64_t number) {
  const Job job = jobs_.at(number);
  if (!job.ended || !job.concluded) return;
  jobs_.erase(number);
  keep(job.record);
}

void JobRecorder::keep(const std::shared_ptr<const JobRecord>& record) {
  if (!record->moved()) return;
  history_.keep(record->started(), [record, grinder = grinder_, machine = machine_, tolerances = tolerances_] {
    return text(record->record(grinder, machine, tolerances));
  });
}

}  // namespace grinder
