#include "flute_grinder/node/planner.h"

#include <utility>

namespace flute_grinder {

Planner::Planner(const Machine& machine) : machine_(machine), thread_([this] { run(); }) {}

void Planner::end() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    if (order_) order_->control->give_up = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool Planner::submit(Order order) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (order_ || ended_) return false;
    order_ = std::move(order);
  }
  changed_.notify_one();
  return true;
}

void Planner::run() {
  while (const std::optional<Order> order = next()) {
    std::unique_ptr<Preview> preview = plan(*order);
    {
      // Ahead of the answer: who has it may submit the next.
      const std::lock_guard<std::mutex> lock(mutex_);
      order_.reset();
    }
    order->done(std::move(preview));
  }
}

std::optional<Planner::Order> Planner::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return order_ || ended_; });
  return order_;
}

std::unique_ptr<Preview> Planner::plan(const Order& order) const {
  auto preview = std::make_unique<Preview>();
  preview->first = order.first;
  if (validate(order.job).empty()) preview->errors.emplace(ConicalCutter(order.job.cutter));
  // Every stroke of a job has the same errors.
  const auto visit = [&](const Setpoint& p) {
    if (p.tooth == order.first.tooth && p.pass == order.first.pass) preview->errors->add(p);
  };
  const auto watch = [&](double done) {
    order.control->done = done;
    return !order.control->give_up;
  };
  preview->plan = planJob(order.job, machine_, order.start, order.first, visit, watch);
  if (preview->plan.good()) preview->stream = std::make_unique<SetpointStream>(preview->plan.program);
  return preview;
}

}  // namespace flute_grinder
