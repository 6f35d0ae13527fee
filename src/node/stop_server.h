#pragma once

#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/Stop.h"
#include "flute_grinder/control/control_loop.h"
#include "node/job_gate.h"
#include "node/served_queue.h"

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <vector>

namespace grinder {

/// Serves every stop: `~hold`, `~disable`, the action's cancel and the topic `~stop`; and `~set_feed_override`. Its own
/// thread does no I/O, logging, publishing or planning, and takes no lock that another thread holds while it does.
class StopServer {
 public:
  /// @param loop,gate must outlive this object.
  StopServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate);

  /// Serves the topic `~grind/cancel` for as long as the returned subscriber lives.
  /// @param pass_on called in this object's thread with each cancel, once the loop has it. It informs actionlib, which
  ///        may block on publishing, and which forwards only the first cancel of a goal.
  ros::Subscriber subscribeToCancels(std::function<void(const actionlib_msgs::GoalID::Ptr&)> pass_on);

 private:
  bool onHold(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onDisable(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onFeedOverride(flute_grinder::SetFeedOverride::Request& request,
                      flute_grinder::SetFeedOverride::Response& response);
  void onStop(const flute_grinder::Stop::ConstPtr& stop);

  ros::NodeHandle nh_;  ///< handle with the thread's queue
  ControlLoop& loop_;
  JobGate& gate_;
  ServedQueue thread_;
  std::vector<ros::ServiceServer> services_;
  ros::Subscriber stops_;
};

}  // namespace grinder
