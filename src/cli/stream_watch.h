#pragma once

#include "cli/csv.h"
#include "flute_grinder/SetpointBatch.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <mutex>
#include <optional>
#include <string>

namespace grinder {

/// Receives the setpoints of this program's own goals, counts them and writes them to a file. Runs in its own thread,
/// so that a slow disk delays nothing else. Thread safe.
class StreamWatch {
 public:
  /// @param nh the grinder's namespace.
  /// @param csv file to write, or empty; close() writes it, if there was a setpoint.
  /// @throw FileError if it cannot be opened.
  StreamWatch(const ros::NodeHandle& nh, const std::string& csv);

  bool connected() const { return subscriber_.getNumPublishers() > 0; }

  /// After the end of the goal, waits until all setpoints are accounted for or no more arrive.
  /// @param written number of setpoints written to the drive, from the goal's result.
  void awaitAll(std::uint64_t written) const;

  std::uint64_t received() const;
  /// The number of setpoints written to the drive, but lost before the grinder could publish them.
  std::uint64_t lost() const;
  /// The number of setpoints published, but not received. @param written see awaitAll(); 0 if unknown.
  std::uint64_t missed(std::uint64_t written) const;
  /// The time from the first setpoint to the last, by the grinder's clock [s].
  double duration() const;

  /// Closes the file. @throw FileError if writing failed.
  void close();

 private:
  void onBatch(const flute_grinder::SetpointBatch::ConstPtr& batch);
  /// The number of setpoints received, reported lost, or missing in a gap between received ones.
  std::uint64_t accountedFor() const;

  const std::string own_goals_;  ///< prefix of the ids of this program's goals
  std::optional<RunCsv> csv_;
  mutable std::mutex mutex_;  ///< guards the next five members, and the file
  std::uint64_t received_ = 0, lost_ = 0;
  std::uint64_t end_cycle_ = 0;  ///< cycle after the last one received
  ros::Time begin_, end_;
  ros::CallbackQueue queue_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

}  // namespace grinder
