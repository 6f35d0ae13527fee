#pragma once

#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/Stop.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/node/job_gate.h"
#include "flute_grinder/node/served_queue.h"

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <vector>

namespace flute_grinder {

/// The road of every stop: `~hold`, `~disable`, `~set_feed_override`, the action's cancel and the topic `~stop`. It has
/// a thread of its own, which takes no lock that anybody holds over I/O, logging, publishing or planning, and does none
/// of these itself.
class StopDesk {
 public:
  /// @param private_nh the node's own namespace.
  /// @param loop,gate must outlive this object.
  StopDesk(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate);

 private:
  bool onHold(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onDisable(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onFeedOverride(SetFeedOverride::Request& request, SetFeedOverride::Response& response);
  void onCancel(const actionlib_msgs::GoalID::ConstPtr& what);
  void onStop(const Stop::ConstPtr& stop);

  ControlLoop& loop_;
  JobGate& gate_;
  ServedQueue thread_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace flute_grinder
