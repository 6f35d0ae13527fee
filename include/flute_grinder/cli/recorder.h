#pragma once

#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/cli/csv.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <mutex>
#include <optional>
#include <string>

namespace flute_grinder {

/// Takes the setpoints of this program's own goals as they are streamed, counts them and writes them to a file. It has
/// a thread of its own, so that a disk that is slow holds up nothing else. Thread safe.
class Recorder {
 public:
  /// @param nh the grinder's namespace.
  /// @param csv file to write, or empty; it is opened, but stays as it was until there is a setpoint for it.
  /// @throw FileError if it cannot be opened.
  Recorder(const ros::NodeHandle& nh, const std::string& csv);

  bool connected() const { return subscriber_.getNumPublishers() > 0; }

  /// Waits for what is under way when the goal has ended: until as many are accounted for, or no more come.
  /// @param written to the drive, by the goal's result.
  void awaitAll(std::uint64_t written) const;

  std::uint64_t received() const;
  /// Written to the drive, but the grinder could not tell them.
  std::uint64_t lost() const;
  /// Told by the grinder, but not received. @param written to the drive, by the goal's result; 0 where that is not
  /// known.
  std::uint64_t missed(std::uint64_t written) const;
  /// From the first setpoint to the last, by the clock of the grinder [s].
  double duration() const;

  /// Ends the record. @throw FileError if not all could be written.
  void close();

 private:
  void onBatch(const SetpointBatch::ConstPtr& batch);
  /// Those received or told as lost, and those that a gap between them tells of.
  std::uint64_t accountedFor() const;

  const std::string own_goals_;  ///< what the ids of this program's goals begin with
  std::optional<SetpointCsv> csv_;
  mutable std::mutex mutex_;  ///< guards the next five, and the file
  std::uint64_t received_ = 0, lost_ = 0;
  std::uint64_t end_cycle_ = 0;  ///< behind the last received
  ros::Time begin_, end_;
  ros::CallbackQueue queue_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

}  // namespace flute_grinder
