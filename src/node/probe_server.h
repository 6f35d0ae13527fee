#pragma once

#include "flute_grinder/ProbeAction.h"
#include "flute_grinder/control/control_loop.h"
#include "node/action_server.h"
#include "node/job_gate.h"
#include "node/offset_server.h"
#include "node/served_queue.h"

#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace grinder {

/// Serves the action `~probe`: probing cycles, each for as long as its client repeats `~probe_alive`. One goal at a
/// time; any other is rejected at once, and jobs are locked out meanwhile. One thread waits for the motion, another
/// takes the messages. Stops go directly to the control loop and end the cycle.
class ProbeServer {
 public:
  /// @param loop,gate,offsets must outlive this object.
  ProbeServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, OffsetServer& offsets);
  ~ProbeServer();

 private:
  using Server = ActionServer<flute_grinder::ProbeAction>;
  using GoalHandle = Server::GoalHandle;

  void onGoal(GoalHandle handle);
  bool isBusy() const;
  void onCancel(const GoalHandle& handle);
  void onAlive(const std_msgs::Header::ConstPtr& message);
  std::string refusal(const flute_grinder::ProbeGoal& goal, const LoopStatus& status) const;
  void run(GoalHandle handle, std::uint64_t stops);
  void runUnguarded(GoalHandle& handle, std::uint64_t stops, flute_grinder::ProbeResult& result);

  ControlLoop& loop_;
  JobGate& gate_;
  OffsetServer& offsets_;
  mutable std::mutex mutex_;        ///< guards the next member; held only to compare, and to post a stop
  std::optional<GoalHandle> goal_;  ///< the goal in progress
  ServedQueue messages_, motion_;
  ros::Subscriber alive_, cancels_;
  std::unique_ptr<Server> server_;
};

}  // namespace grinder
