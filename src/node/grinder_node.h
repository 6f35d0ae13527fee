#pragma once

#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/control/loop_watchdog.h"
#include "flute_grinder/control/machine_config.h"
#include "node/drive_plugin.h"
#include "node/goal_server.h"
#include "node/history.h"
#include "node/job_gate.h"
#include "node/journal.h"
#include "node/offset_server.h"
#include "node/offset_store.h"
#include "node/planner.h"
#include "node/probe_server.h"
#include "node/request_server.h"
#include "node/stop_server.h"
#include "node/telemetry.h"

#include <ros/ros.h>

#include <memory>
#include <string>

namespace grinder {

/// The grinder as a ROS node: loads the drive, runs the control loop, and connects it to the action, services and
/// topics through parts that each run in their own thread (see docs/architecture.md). The drive's own callbacks are in
/// the global queue, which the program must serve.
class GrinderNode {
 public:
  /// Reads all parameters, loads and initialises the drive, and starts the control loop.
  /// @param nh the node's namespace, for robot_description and joint_states.
  /// @param private_nh the node's private namespace, for everything else.
  /// @param plugin with nothing loaded yet; must outlive this object.
  /// @throw std::exception naming the parameter, plugin or joint at fault, or the owner of an atomic file.
  GrinderNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, DrivePlugin& plugin);
  ~GrinderNode();

  /// Stops a running job on the path, lifts the wheel, ends the goal and switches the drive off. No job can start once
  /// this has been called.
  /// @return the function of the drive that hangs; empty if none. If one hangs, its thread does not end, and the
  /// process must end without waiting for it.
  [[nodiscard]] std::string shutDown();

 private:
  std::string hangingFunction() const;

  ros::NodeHandle nh_, private_nh_;
  std::unique_ptr<Journal> journal_;
  std::unique_ptr<OffsetStore> offsets_;
  std::unique_ptr<History> history_;
  ros::Publisher machine_;  ///< keeps the latched message
  std::unique_ptr<ControlLoop> loop_;
  std::unique_ptr<LoopWatchdog> watchdog_;
  JobGate gate_;
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<Telemetry> telemetry_;
  std::unique_ptr<StopServer> stops_;
  std::unique_ptr<OffsetServer> offset_server_;
  std::unique_ptr<RequestServer> requests_;
  std::unique_ptr<ProbeServer> probes_;
  std::unique_ptr<GoalServer> goals_;
};

}  // namespace grinder
