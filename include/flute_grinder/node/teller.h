#pragma once

#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/node/diagnostics.h"
#include "flute_grinder/node/journal_keeper.h"
#include "flute_grinder/node/planner.h"
#include "flute_grinder/node/served_queue.h"
#include "flute_grinder/scene/scene.h"

#include <actionlib_msgs/GoalID.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <atomic>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace flute_grinder {

/// Tells what the control loop does: joint states, `~state`, `~setpoints`, the action's feedback, what rviz shows, and
/// diagnostics. It has a thread of its own, which takes the loop's records; no thread blocks on it, and when it
/// has been away for too long, records are lost, which it tells.
class Teller {
 public:
  /// @param nh the node's namespace, for joint_states.
  /// @param private_nh the node's own, for all else.
  /// @param loop,journal must outlive this object.
  Teller(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, ControlLoop& loop, const JournalKeeper& journal,
         const DiagnosticThresholds& thresholds);

  /// Begins to tell.
  void start() { thread_.start(); }

  /// Shows a good plan, unless there is a job. Thread safe; waits for nothing.
  void show(std::shared_ptr<const Preview> preview);
  /// Announces a job, ahead of its start. Thread safe; waits for nothing.
  /// @param number that the loop will give it.
  void follow(std::uint64_t number, const actionlib_msgs::GoalID& goal, std::shared_ptr<const Preview> preview);
  /// The job announced last will not be started. Thread safe; waits for nothing.
  void forget(std::uint64_t number);

  /// Number of the last job that was told to its end. Thread safe.
  std::uint64_t jobsTold() const { return jobs_told_; }

 private:
  /// A setpoint that is in the drive's buffer.
  struct Waiting {
    std::uint64_t cycle;  ///< of the loop, that made it
    double period;        ///< of that cycle, measured [s]
    Setpoint setpoint;
  };

  struct Job {
    std::uint64_t number;
    actionlib_msgs::GoalID goal;
    std::shared_ptr<const Preview> preview;
    bool shown = false;
    Setpoint last{};                ///< of those that the axes have got
    double largest_error = 0;       ///< since the last feedback [rad]
    std::uint64_t next_cycle = 0;   ///< of the setpoint to be told next
    std::deque<Waiting> waiting{};  ///< written, and not told yet
  };

  void tick();
  void takeRecords();
  void takeRecord();
  void followJob(Job& job);
  void tell(Job& job, const Waiting& written);
  void endJob(Job& job);
  void publishJointStates();
  void publishBatch();
  void publishState();
  void publishFeedback();
  Job* running();
  std::uint64_t cycle() const { return taken_ + record_.records_lost; }  ///< of the loop, since its start

  ControlLoop& loop_;
  const JournalKeeper& journal_;
  Diagnostics diagnostics_;
  diagnostic_updater::Updater diagnostic_updater_;
  ros::Publisher joint_states_, state_, setpoints_, feedback_;
  Scene scene_;

  CycleRecord record_;  ///< the newest
  std::uint64_t taken_ = 0;
  std::deque<Job> jobs_;  ///< announced; the first may run
  SetpointBatch batch_;
  std::uint64_t ticks_ = 0;
  std::uint64_t ticks_per_diagnostics_ = 1;
  std::atomic<std::uint64_t> jobs_told_{0};

  ServedQueue thread_;  ///< last, so that it has ended when the rest goes
};

}  // namespace flute_grinder
