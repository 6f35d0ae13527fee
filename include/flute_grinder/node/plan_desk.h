#pragma once

#include "flute_grinder/Plan.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/node/planner.h"
#include "flute_grinder/node/teller.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <memory>

namespace flute_grinder {

/// The service `~plan`. One call waits for the planner; whoever calls meanwhile is told that it is busy.
class PlanDesk {
 public:
  /// @param private_nh the node's own namespace.
  /// @param loop,planner,teller must outlive this object.
  PlanDesk(const ros::NodeHandle& private_nh, const ControlLoop& loop, Planner& planner, Teller& teller);
  ~PlanDesk();

 private:
  bool onPlan(Plan::Request& request, Plan::Response& response);

  const ControlLoop& loop_;
  Planner& planner_;
  Teller& teller_;
  std::shared_ptr<PlanControl> control_;
  ros::CallbackQueue queue_;
  ros::ServiceServer service_;
  ros::AsyncSpinner spinner_;  ///< last, so that no call is under way when the rest goes
};

}  // namespace flute_grinder
