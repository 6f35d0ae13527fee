#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

namespace grinder {

/// The newest message of a topic, with the time at which it came. Thread safe.
template <typename Message>
class Latest {
 public:
  using ConstPtr = boost::shared_ptr<const Message>;

  /// Both functions are called in the thread that receives the messages.
  /// @param accept called with each message before it becomes the newest; false drops it. Null: all are taken.
  /// @param taken called once it is the newest; may be null.
  Latest(ros::NodeHandle nh, const std::string& topic, std::function<bool(const Message&)> accept = nullptr,
         std::function<void()> taken = nullptr)
      : accept_(std::move(accept)), taken_(std::move(taken)) {
    const boost::function<void(const ConstPtr&)> take = [this](const ConstPtr& message) { this->take(message); };
    subscriber_ = nh.subscribe<Message>(topic, kQueue, take, {}, ros::TransportHints().tcpNoDelay());
  }

  /// Null before the first one.
  ConstPtr newest() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return newest_;
  }
  /// Whether the newest came within this time.
  bool isFresh(const ros::WallDuration& within) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return newest_ && ros::SteadyTime::now() - time_ <= within;
  }
  /// How many have come.
  std::uint64_t count() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return count_;
  }

 private:
  static constexpr int kQueue = 10;

  void take(const ConstPtr& message) {
    if (accept_ && !accept_(*message)) return;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      newest_ = message;
      time_ = ros::SteadyTime::now();
      ++count_;
    }
    if (taken_) taken_();
  }

  const std::function<bool(const Message&)> accept_;
  const std::function<void()> taken_;
  mutable std::mutex mutex_;  ///< guards the next three members
  ConstPtr newest_;
  ros::SteadyTime time_;
  std::uint64_t count_ = 0;
  ros::Subscriber subscriber_;
};

}  // namespace grinder
