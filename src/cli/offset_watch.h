#pragma once

#include "flute_grinder/WorkOffsets.h"

#include <ros/ros.h>

#include <mutex>

namespace grinder {

/// Receives the work offsets. Thread safe.
class OffsetWatch {
 public:
  /// @param nh the grinder's namespace.
  explicit OffsetWatch(ros::NodeHandle& nh) {
    const boost::function<void(const flute_grinder::WorkOffsets::ConstPtr&)> on_offsets =
        [this](const flute_grinder::WorkOffsets::ConstPtr& offsets) {
          const std::lock_guard<std::mutex> lock(mutex_);
          newest_ = offsets;
        };
    subscriber_ = nh.subscribe<flute_grinder::WorkOffsets>("offsets", 10, on_offsets);
  }
  /// The newest work offsets; null before the first.
  flute_grinder::WorkOffsets::ConstPtr newest() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return newest_;
  }

 private:
  mutable std::mutex mutex_;
  flute_grinder::WorkOffsets::ConstPtr newest_;
  ros::Subscriber subscriber_;
};

}  // namespace grinder
