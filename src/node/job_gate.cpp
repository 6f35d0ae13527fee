#include "node/job_gate.h"

#include <utility>

namespace grinder {

namespace {

bool namesNone(const actionlib_msgs::GoalID& cancel) { return cancel.id.empty() && cancel.stamp.isZero(); }

bool isMeantFor(const actionlib_msgs::GoalID& cancel, const actionlib_msgs::GoalID& goal) {
  if (namesNone(cancel) || cancel.id == goal.id) return true;
  return !cancel.stamp.isZero() && goal.stamp <= cancel.stamp;
}

}  // namespace

bool JobGate::open(const actionlib_msgs::GoalID& goal, std::function<void()> give_up) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (shut_ || shut_outs_ > 0) return false;
  phase_ = Phase::kAhead;
  goal_ = goal;
  give_up_ = std::move(give_up);
  canceled_ = false;
  held_ = false;
  return true;
}

bool JobGate::start(const std::function<void(bool held)>& start) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (phase_ != Phase::kAhead || canceled_) return false;
  phase_ = Phase::kStarted;
  start(held_);
  return true;
}

void JobGate::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  phase_ = Phase::kIdle;
  give_up_ = nullptr;
}

bool JobGate::cancel(const actionlib_msgs::GoalID& what) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (phase_ != Phase::kIdle && isMeantFor(what, goal_)) giveUp();
  // A lift has no goal: a cancel that names no goal stops it too.
  return namesNone(what) || (phase_ == Phase::kStarted && canceled_);
}

bool JobGate::hold() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (phase_ == Phase::kAhead) held_ = true;
  return phase_ == Phase::kAhead;
}

bool JobGate::resume() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool held = phase_ == Phase::kAhead && held_;
  if (held) held_ = false;
  return held;
}

void JobGate::shut() {
  const std::lock_guard<std::mutex> lock(mutex_);
  shut_ = true;
  if (phase_ != Phase::kIdle) giveUp();
}

bool JobGate::lockOutJobs() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (phase_ != Phase::kIdle) return false;
  ++shut_outs_;
  return true;
}

void JobGate::letJobsIn() {
  const std::lock_guard<std::mutex> lock(mutex_);
  --shut_outs_;
}

bool JobGate::isShut() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return shut_;
}

bool JobGate::canceled() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return canceled_;
}

void JobGate::giveUp() {
  if (phase_ == Phase::kAhead && !canceled_ && give_up_) give_up_();
  canceled_ = true;
}

}  // namespace grinder
