#pragma once

#include "flute_grinder/GrindAction.h"
#include "flute_grinder/Plan.h"
#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/core/job_plan.h"
#include "flute_grinder/drive/control_loop.h"
#include "flute_grinder/drive/machine_config.h"
#include "flute_grinder/node/diagnostics.h"
#include "flute_grinder/node/journal.h"
#include "flute_grinder/node/scene.h"

#include <actionlib/server/action_server.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_loader.hpp>

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace flute_grinder {

/// The grinder in ROS: loads the drive, runs the control loop, and connects it with the action, the services and the
/// topics. Callbacks may come from several threads.
class GrinderNode {
 public:
  /// Reads all parameters, loads and initialises the drive, and starts the control loop.
  /// @param nh the node's namespace, for robot_description and joint_states.
  /// @param private_nh the node's own, for all else.
  /// @throw std::exception naming the parameter, the plugin or the joint that is at fault.
  GrinderNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

  /// Stops a running job on its path, ends its goal, and switches the drive off.
  void shutDown();

 private:
  using Server = actionlib::ActionServer<GrindAction>;
  using GoalHandle = Server::GoalHandle;

  /// A setpoint that is in the drive's buffer.
  struct Waiting {
    std::uint64_t cycle;  ///< that made it
    double period;        ///< of that cycle, measured [s]
    Setpoint setpoint;
  };

  /// The job that moves the machine.
  struct Job {
    GoalHandle goal;
    std::unique_ptr<SetpointStream> stream;
    PlanStatistics statistics;
    std::vector<std::uint64_t> move_ends;  ///< as planned
    std::vector<ToothPass> passes;         ///< in order
    Setpoint last;                         ///< of those that the axes have got
    double largest_error = 0;              ///< since the last feedback [rad]
    std::uint64_t written = 0;
    bool canceled = false;
    std::uint64_t cycle = 0;  ///< since the start
    std::deque<Waiting> waiting{};
  };

  /// A plan with what is to be shown of it.
  struct Preview {
    JobPlan plan;
    ToothPass first;                         ///< to grind
    std::optional<PathErrorMarkers> errors;  ///< of its first stroke; of a job whose figures are allowed
  };

  void loadDrive(const ParameterReader& parameters);
  void readJournal();
  void advertise();

  void onGoal(GoalHandle goal);
  void onCancel(const GoalHandle& goal);
  Preview makePreview(const GrindGoal& goal, const Axes& start) const;
  void show(const Preview& preview);
  void startJob(GoalHandle& goal, JobPlan& plan);
  void cancelJob();
  RequestReply ask(MachineEvent event);
  RequestReply askToStart(SetpointStream* stream);
  bool onRequest(MachineEvent event, std_srvs::Trigger::Response& response);
  bool onFeedOverride(SetFeedOverride::Request& request, SetFeedOverride::Response& response);
  bool onPlan(Plan::Request& request, Plan::Response& response);

  void tick();
  void takeRecords();
  bool refresh();
  void follow(const CycleRecord& record);
  void followJob(const CycleRecord& record);
  void tell(const Waiting& written, const CycleRecord& record);
  void trackProgress(const Setpoint& setpoint);
  std::string writeJournal();
  double plannedCycles() const;
  GrindResult resultOf(const Job& job, int code, const std::string& text) const;
  void finishJob(const CycleRecord& record);
  void publishJointStates();
  void publishBatch();
  void publishState();
  void publishFeedback();
  void reject(GoalHandle& goal, int code, const std::string& text);

  ros::NodeHandle nh_, private_nh_;
  std::unique_ptr<pluginlib::ClassLoader<RobotHW>> loader_;
  pluginlib::UniquePtr<RobotHW> hw_;
  std::unique_ptr<ControlLoop> loop_;
  std::unique_ptr<Journal> journal_;
  std::unique_ptr<Diagnostics> diagnostics_;

  std::unique_ptr<Server> server_;
  std::vector<ros::ServiceServer> services_;
  ros::Publisher joint_states_, state_, setpoints_;
  std::unique_ptr<diagnostic_updater::Updater> diagnostic_updater_;
  ros::SteadyTimer timer_;

  std::mutex request_mutex_;
  std::mutex mutex_;    ///< guards all below
  CycleRecord record_;  ///< the newest
  std::uint64_t records_ = 0;
  std::unique_ptr<Job> job_;
  std::unique_ptr<Scene> scene_;
  Progress progress_;  ///< of the running job, or of the last one
  bool progress_made_ = false;
  std::optional<GoalHandle> planning_;
  bool planning_canceled_ = false;
  SetpointBatch batch_;
  std::uint64_t ticks_ = 0;
};

}  // namespace flute_grinder
