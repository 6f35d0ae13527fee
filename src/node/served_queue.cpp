#include "node/served_queue.h"

#include <boost/make_shared.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace grinder {

namespace {

constexpr double kIdlePeriod = 1;  ///< period of a queue without a `poll` [s]

std::chrono::steady_clock::duration toDuration(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
}

class Task : public ros::CallbackInterface {
 public:
  explicit Task(std::function<void()> task) : task_(std::move(task)) {}
  CallResult call() override {
    task_();
    return Success;
  }

 private:
  std::function<void()> task_;
};

}  // namespace

ServedQueue::ServedQueue(double period, std::function<void()> poll)
    : period_(toDuration(period)), poll_(std::move(poll)) {}

ServedQueue::ServedQueue() : ServedQueue(kIdlePeriod, [] {}) {}

ServedQueue::~ServedQueue() { stop(); }

void ServedQueue::start() {
  running_ = true;
  thread_ = std::thread([this] { run(); });
}

void ServedQueue::stop() {
  if (!thread_.joinable()) return;
  post([this] { running_ = false; });
  thread_.join();
  queue_.disable();
  queue_.clear();
}

void ServedQueue::post(std::function<void()> task) { queue_.addCallback(boost::make_shared<Task>(std::move(task))); }

void ServedQueue::setPeriod(double period) {
  period_ = toDuration(period);
  next_poll_ = std::min(next_poll_, Clock::now() + period_);
}

void ServedQueue::run() {
  next_poll_ = Clock::now() + period_;
  while (running_) {
    const std::chrono::duration<double> left = next_poll_ - Clock::now();
    queue_.callOne(ros::WallDuration(std::max(0.0, left.count())));
    const Clock::time_point now = Clock::now();
    if (now < next_poll_) continue;
    poll_();
    // Skip polls that were missed.
    next_poll_ = std::max(next_poll_ + period_, now);
  }
}

}  // namespace grinder
