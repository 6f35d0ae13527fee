#pragma once

#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/Stop.h"
#include "flute_grinder/control/control_loop.h"
#include "node/job_gate.h"
#include "node/served_queue.h"

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <vector>

namespace grinder {

/// Serves every stop: `~hold`, `~disable`, the action's cancel and the topic `~stop`; and `~set_feed_override`. Its own
/// thread does no I/O, logging, publishing or planning, and takes no lock that another thread holds while it does.
class StopServer {
 public:
  /// @param private_nh the node's own namespace.
  /// @param loop,gate must outlive this object.
  StopServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate);

 private:
  bool onHold(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onDisable(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onFeedOverride(flute_grinder::SetFeedOverride::Request& request,
                      flute_grinder::SetFeedOverride::Response& response);
  void onCancel(const actionlib_msgs::GoalID::ConstPtr& what);
  void onStop(const flute_grinder::Stop::ConstPtr& stop);

  ControlLoop& loop_;
  JobGate& gate_;
  ServedQueue thread_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace grinder
