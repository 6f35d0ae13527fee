#pragma once

#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/node/goal_desk.h"
#include "flute_grinder/node/job_gate.h"
#include "flute_grinder/node/journal_keeper.h"
#include "flute_grinder/node/plan_desk.h"
#include "flute_grinder/node/planner.h"
#include "flute_grinder/node/request_desk.h"
#include "flute_grinder/node/stop_desk.h"
#include "flute_grinder/node/teller.h"

#include <ros/ros.h>
#include <pluginlib/class_loader.hpp>

#include <memory>
#include <string>

namespace flute_grinder {

/// The grinder in ROS: loads the drive, runs the control loop, and connects it with the action, the services and the
/// topics by parts that each have a thread of their own; docs/architecture.md has the picture. The drive's own
/// callbacks are in the global queue, which the program must serve.
class GrinderNode {
 public:
  /// Reads all parameters, loads and initialises the drive, and starts the control loop.
  /// @param nh the node's namespace, for robot_description and joint_states.
  /// @param private_nh the node's own, for all else.
  /// @throw std::exception naming the parameter, the plugin or the joint that is at fault, or who has the journal.
  GrinderNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);
  ~GrinderNode();

  /// Stops a running job on its path, lifts the wheel, ends its goal, and switches the drive off. From its first moment
  /// on no job starts any more.
  void shutDown();

 private:
  void loadDrive(const ParameterReader& parameters);

  ros::NodeHandle nh_, private_nh_;
  std::unique_ptr<pluginlib::ClassLoader<RobotHW>> loader_;
  pluginlib::UniquePtr<RobotHW> hw_;
  std::unique_ptr<JournalKeeper> journal_;
  std::unique_ptr<ControlLoop> loop_;
  JobGate gate_;
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<Teller> teller_;
  std::unique_ptr<StopDesk> stops_;
  std::unique_ptr<RequestDesk> requests_;
  std::unique_ptr<PlanDesk> plans_;
  std::unique_ptr<GoalDesk> goals_;
};

}  // namespace flute_grinder
