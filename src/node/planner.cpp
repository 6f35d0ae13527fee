#include "node/planner.h"

#include "flute_grinder/job/job_digest.h"

#include <string>
#include <utility>

namespace grinder {

namespace {

/// The digest of the operation after a job's; empty after the last.
std::string digestOfNext(const GrindJob& job) {
  return job.next() == nullptr ? "" : jobDigest(job.ofOperation(job.operation + 1));
}

}  // namespace

Planner::Planner(const Machine& machine, const MachineShapes& shapes)
    : machine_(machine), shapes_(shapes), thread_([this] { run(); }) {}

void Planner::end() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    if (request_) request_->control->give_up = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool Planner::submit(Request request) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ended_ || request_) return false;
    request_ = std::move(request);
  }
  changed_.notify_one();
  return true;
}

void Planner::run() {
  while (const std::optional<Request> request = next()) {
    std::shared_ptr<const PlannedJob> plan = this->plan(*request);
    {
      // Before `done`: it may submit the next job.
      const std::lock_guard<std::mutex> lock(mutex_);
      request_.reset();
    }
    request->done(std::move(plan));
  }
}

std::optional<Planner::Request> Planner::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return request_ || ended_; });
  return request_;
}

std::shared_ptr<const PlannedJob> Planner::plan(const Request& request) {
  if (isKept(request) && (kept_->passes || !request.measures_passes)) return kept_;
  auto plan = std::make_shared<const PlannedJob>(makePlan(request));
  if (plan->good()) kept_ = plan;
  return plan;
}

bool Planner::isKept(const Request& request) const {
  if (!kept_ || kept_->program->job().digest() != request.job.digest() || !(kept_->program->run() == request.run))
    return false;
  // The digest does not contain the operations that follow, but the next one decides how a relief or a gash is judged.
  return digestOfNext(*kept_->program->job()) == digestOfNext(*request.job);
}

PlannedJob Planner::makePlan(const Request& request) const {
  const auto watch = [&](double done) {
    request.control->done = done;
    return !request.control->give_up;
  };
  PlannedJob plan = isKept(request) ? *kept_ : planWholeJob(request.job, machine_, shapes_, request.run, {}, watch);
  if (request.measures_passes) measurePasses(plan, watch);
  return plan;
}

}  // namespace grinder
