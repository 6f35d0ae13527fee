#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace grinder {

/// The newest message of a topic, with the time at which it came. Thread safe. roscpp destroys a subscriber while its
/// callback runs; therefore the callback owns what it writes together with this object.
template <typename Message>
class Latest {
 public:
  using ConstPtr = boost::shared_ptr<const Message>;

  /// Both functions are called in the thread that receives the messages, and may be once more while this object is
  /// destroyed, unless that thread was stopped before.
  /// @param accept called with each message before it becomes the newest; false drops it. Null: all are taken.
  /// @param taken called once it is the newest; may be null.
  Latest(ros::NodeHandle nh, const std::string& topic, std::function<bool(const Message&)> accept = nullptr,
         std::function<void()> taken = nullptr) {
    const boost::function<void(const ConstPtr&)> take = [inbox = inbox_, accept = std::move(accept),
                                                         taken = std::move(taken)](const ConstPtr& message) {
      if (accept && !accept(*message)) return;
      inbox->put(message);
      if (taken) taken();
    };
    subscriber_ = nh.subscribe<Message>(topic, kQueue, take, {}, ros::TransportHints().tcpNoDelay());
  }

  /// Null before the first one.
  ConstPtr newest() const {
    const std::lock_guard<std::mutex> lock(inbox_->mutex);
    return inbox_->newest;
  }
  /// Whether the newest came within this time.
  bool isFresh(const ros::WallDuration& within) const {
    const std::lock_guard<std::mutex> lock(inbox_->mutex);
    return inbox_->newest && ros::SteadyTime::now() - inbox_->time <= within;
  }
  /// How many have come.
  std::uint64_t count() const {
    const std::lock_guard<std::mutex> lock(inbox_->mutex);
    return inbox_->count;
  }

 private:
  static constexpr int kQueue = 10;

  struct Inbox {
    void put(const ConstPtr& message) {
      const std::lock_guard<std::mutex> lock(mutex);
      newest = message;
      time = ros::SteadyTime::now();
      ++count;
    }

    std::mutex mutex;  ///< guards the other members
    ConstPtr newest;
    ros::SteadyTime time;
    std::uint64_t count = 0;
  };

  const std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
  ros::Subscriber subscriber_;
};

}  // namespace grinder
