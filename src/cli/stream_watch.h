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
  /// @param csv file to write, or empty; it is opened, but unchanged until close(), and then if there is a setpoint.
  /// @throw FileError if it cannot be opened.
  StreamWatch(const ros::NodeHandle& nh, const std::string& csv);

  bool connected() const { return subscriber_.getNumPublishers() > 0; }

  /// After the end of the goal, waits until all setpoints are accounted for or no more arrive.
  /// @param written to the drive, as the goal's result says.
  void awaitAll(std::uint64_t written) const;

  std::uint64_t received() const;
  /// Written to the drive, but lost before the grinder could publish them.
  std::uint64_t lost() const;
  /// Published by the grinder, but not received. @param written to the drive, as the goal's result says; 0 if unknown.
  std::uint64_t missed(std::uint64_t written) const;
  /// From the first setpoint to the last, by the clock of the grinder [s].
  double duration() const;

  /// Closes the file. @throw FileError if writing failed.
  void close();

 private:
  void onBatch(const flute_grinder::SetpointBatch::ConstPtr& batch);
  /// Setpoints received, reported lost, or missing in a gap between those received.
  std::uint64_t accountedFor() const;

  const std::string own_goals_;  ///< prefix of the ids of this program's goals
  std::optional<RunCsv> csv_;
  mutable std::mutex mutex_;  ///< guards the next five, and the file
  std::uint64_t received_ = 0, lost_ = 0;
  std::uint64_t end_cycle_ = 0;  ///< one past the last received
  ros::Time begin_, end_;
  ros::CallbackQueue queue_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

}  // namespace grinder
