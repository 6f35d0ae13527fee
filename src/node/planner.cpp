#include "flute_grinder/node/planner.h"

#include "flute_grinder/collision/job_collision.h"
#include "flute_grinder/geometry/ground_job.h"

#include <utility>

namespace flute_grinder {

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
    if (request_ || ended_) return false;
    request_ = std::move(request);
  }
  changed_.notify_one();
  return true;
}

void Planner::run() {
  while (const std::optional<Request> request = next()) {
    std::unique_ptr<Preview> preview = plan(*request);
    {
      // Before `done`: it may submit the next job.
      const std::lock_guard<std::mutex> lock(mutex_);
      request_.reset();
    }
    request->done(std::move(preview));
  }
}

std::optional<Planner::Request> Planner::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return request_ || ended_; });
  return request_;
}

std::unique_ptr<Preview> Planner::plan(const Request& request) const {
  auto preview = std::make_unique<Preview>();
  preview->first = request.first;
  if (validate(request.job).empty()) preview->errors.emplace(request.job);
  // Every stroke of a job has the same errors.
  const auto visit = [&](const Setpoint& p) {
    if (p.tooth == request.first.tooth && p.pass == request.first.pass) preview->errors->add(p);
  };
  const auto watch = [&](double done) {
    request.control->done = done;
    return !request.control->give_up;
  };
  Machine machine = machine_;
  machine.work_offset = request.offset;
  preview->plan = planGroundJob(request.job, machine, request.start - request.offset, request.first, visit, watch);
  checkCollision(preview->plan, shapes_);
  if (preview->plan.good()) preview->stream = std::make_unique<SetpointStream>(preview->plan.program);
  return preview;
}

}  // namespace flute_grinder
