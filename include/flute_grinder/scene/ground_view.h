#pragma once

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/scene/ground_markers.h"

#include <ros/ros.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace grinder {

/// Shows the ground cutter in rviz on `~ground_cutter`, latched. It is computed in a separate thread at low priority: a
/// plan at once, a running job at most once a second and with a twentieth of a core. Only the latest request counts.
/// Thread safe; the calls do not wait for the computation.
class GroundView {
 public:
  explicit GroundView(ros::NodeHandle private_nh);
  ~GroundView();

  /// @param reached progress of the job; nothing for the finished tool.
  void show(const std::optional<ValidJob>& job, const std::optional<Reached>& reached);

  /// Removes the cutter from rviz.
  void clear() { show(std::nullopt, std::nullopt); }

 private:
  struct Request {
    std::optional<ValidJob> job;  ///< job to show; nothing to clear the view
    std::optional<Reached> reached;
  };

  void run();
  std::optional<Request> next(std::chrono::steady_clock::time_point earliest);

  ros::Publisher publisher_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> request_;
  bool ended_ = false;
  std::thread thread_;  ///< last member, so that the others exist when it starts
};

}  // namespace grinder
