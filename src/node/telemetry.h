#pragma once

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/control/loop_watchdog.h"
#include "node/diagnostics.h"
#include "node/frames.h"
#include "node/job_feed.h"
#include "node/journal.h"
#include "node/offset_store.h"
#include "node/recorder_watch.h"
#include "node/robot_status.h"
#include "node/served_queue.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Publishes what the control loop does: joint states, `~state`, the frames for rviz, and diagnostics; JobFeed does
/// what concerns a job. Its own thread reads the loop's samples; nothing blocks on it. If it falls too far behind,
/// samples are lost, and it reports how many. While nothing changes, it publishes less often.
class Telemetry {
 public:
  /// @param nh the node's namespace, for joint_states.
  /// @param private_nh the node's private namespace, for everything else.
  /// @param loop,journal,offsets,history must outlive this object.
  Telemetry(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, ControlLoop& loop, const Journal& journal,
            const OffsetStore& offsets, History& history, const Tolerances& tolerances, const MachineInfo& machine,
            const DiagnosticThresholds& thresholds, const MachineModel& model, const FirstView& first_view);
  ~Telemetry();

  /// Starts publishing. @param watchdog must outlive this object.
  void start(const LoopWatchdog& watchdog) {
    watchdog_ = &watchdog;
    thread_.start();
  }

  /// Shows a valid plan, unless a job is running, until its zero points or the wheel on the spindle change. Thread
  /// safe; never blocks.
  void show(std::shared_ptr<const PlannedJob> plan, const std::string& job_name);
  /// Announces a job before it starts. Thread safe; never blocks.
  /// @param number the loop's number for this job. @param goal_id,job_name id and job name of the goal. @param record a
  /// new record.
  void announceJob(std::uint64_t number, const std::string& goal_id, const std::string& job_name,
                   std::shared_ptr<const PlannedJob> plan, std::shared_ptr<JobRecord> record);
  /// The feedback of a job that was computed since the last call, if there is one. Thread safe; never blocks.
  std::optional<flute_grinder::GrindFeedback> takeFeedback(std::uint64_t number) { return jobs_.takeFeedback(number); }
  /// Withdraws the job announced last, because it will not start. Thread safe; never blocks.
  void withdrawJob(std::uint64_t number);
  /// Hands over the result of a job, for its record. Thread safe; never blocks.
  void concludeJob(std::uint64_t number, const JobConclusion& conclusion);
  /// Removes the job from rviz, and shows no other any more. Thread safe; never blocks.
  void clearScene();

  /// Number of the last job whose setpoints have all been published. Thread safe.
  std::uint64_t jobsPublished() const { return jobs_.published(); }

 private:
  void tick();
  bool setPace();
  flute_grinder::GrinderState stateMessage() const;
  void readSamples();
  void logFault();
  void logHang();
  LoopFault hang() const;
  void replaceByHang(flute_grinder::GrinderState& message) const;
  void publishJointStates();
  void publishDiagnostics();
  void publishState();

  ControlLoop& loop_;
  const Journal& journal_;
  const OffsetStore& offsets_;
  const History& history_;
  Diagnostics diagnostics_;
  diagnostic_updater::Updater diagnostic_updater_;
  ros::Publisher joint_states_, state_;
  RecorderWatch recorder_watch_;
  RobotStatus robot_status_;
  Frames frames_;
  JobFeed jobs_;

  CycleSample sample_;  ///< the latest sample
  std::uint64_t samples_read_ = 0;
  bool in_fault_ = false;  ///< the previous sample was in state kFault
  const LoopWatchdog* watchdog_ = nullptr;
  LoopWatchdog::Finding finding_ = LoopWatchdog::Finding::kRuns;  ///< last finding of the watchdog
  std::uint64_t ticks_ = 0;
  ros::SerializedMessage last_state_;  ///< last state published, without its stamp
  ros::SteadyTime last_change_;        ///< time of the last change of anything published
  bool resting_ = false;
  ros::WallDuration diagnostics_period_;
  ros::SteadyTime next_diagnostics_;

  ServedQueue thread_;  ///< last member, so that it stops before the others are destroyed
};

}  // namespace grinder
