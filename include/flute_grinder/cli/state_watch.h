#pragma once

#include "flute_grinder/GrinderState.h"

#include <ros/ros.h>

#include <mutex>

namespace flute_grinder {

/// Whether a job has the machine.
bool inJob(const GrinderState& state);

/// Waits for a condition. @return whether it came true in time.
template <typename Condition>
bool await(const ros::WallDuration& timeout, Condition condition) {
  const ros::SteadyTime end = ros::SteadyTime::now() + timeout;
  while (ros::ok() && !condition()) {
    if (ros::SteadyTime::now() > end) return false;
    ros::WallDuration(0.005).sleep();
  }
  return condition();
}

const ros::WallDuration kPatience(10);  ///< with a node that is only just coming up

/// Listens to what the grinder says of its state, 20 times a second; a spinner must run.
class StateWatch {
 public:
  /// @param nh the grinder's namespace.
  explicit StateWatch(ros::NodeHandle& nh);

  /// Whether the grinder has told of itself.
  bool begun() const { return heard() > 0; }
  /// Waits for what is told from now on. @return false if the link is lost.
  bool renew() const;
  GrinderState newest() const;
  /// Whether nothing was heard of the grinder for too long.
  bool lost() const;

 private:
  std::uint64_t heard() const;

  mutable std::mutex mutex_;
  GrinderState newest_;
  ros::SteadyTime time_;  ///< of the newest
  std::uint64_t heard_ = 0;
  ros::Subscriber subscriber_;
};

/// For when the watch is lost.
extern const char* const kLinkLost;

}  // namespace flute_grinder
