#include "cli/stream_watch.h"

#include "cli/waiting.h"
#include "flute_grinder/messages/conversions.h"

#include <algorithm>

namespace grinder {

namespace {

const ros::WallDuration kBatchTimeout(2);  ///< longest gap between two batches

}  // namespace

StreamWatch::StreamWatch(const ros::NodeHandle& nh, const std::string& csv)
    : own_goals_(ros::this_node::getName() + "-"), spinner_(1, &queue_) {
  if (!csv.empty()) csv_.emplace(csv);
  ros::NodeHandle own(nh);
  own.setCallbackQueue(&queue_);
  subscriber_ = own.subscribe("setpoints", 1000, &StreamWatch::onBatch, this);
  spinner_.start();
}

void StreamWatch::onBatch(const flute_grinder::SetpointBatch::ConstPtr& batch) {
  if (batch->goal_id.compare(0, own_goals_.size(), own_goals_) != 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  lost_ += batch->lost;
  if (batch->setpoints.empty()) return;
  if (received_ == 0) begin_ = batch->header.stamp;
  end_ = batch->end_stamp;
  for (const flute_grinder::WrittenSetpoint& setpoint : batch->setpoints) {
    ++received_;
    end_cycle_ = std::max(end_cycle_, setpoint.cycle + 1);
    if (csv_) csv_->write(fromMessage(setpoint), Axes(setpoint.actual.data()), batch->period);
  }
}

void StreamWatch::awaitAll(std::uint64_t written) const {
  for (std::uint64_t seen = accountedFor(); seen < written; seen = accountedFor()) {
    if (!await(kBatchTimeout, [&] { return accountedFor() > seen; })) return;
  }
}

std::uint64_t StreamWatch::received() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return received_;
}

std::uint64_t StreamWatch::lost() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return lost_;
}

std::uint64_t StreamWatch::accountedFor() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::max(end_cycle_, received_ + lost_);
}

std::uint64_t StreamWatch::missed(std::uint64_t written) const {
  const std::uint64_t all = std::max(written, accountedFor());
  const std::lock_guard<std::mutex> lock(mutex_);
  return all - received_ - lost_;
}

double StreamWatch::duration() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return end_.toSec() - begin_.toSec();
}

void StreamWatch::close() {
  subscriber_.shutdown();
  spinner_.stop();
  if (csv_ && received_ > 0) csv_->close();
}

}  // namespace grinder
