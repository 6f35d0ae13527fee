#pragma once

#include "flute_grinder/Plan.h"
#include "flute_grinder/control/control_loop.h"
#include "node/offset_store.h"
#include "node/planner.h"
#include "node/telemetry.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <memory>

namespace grinder {

/// Serves `~plan`. One call waits for the planner; any other is answered "busy" meanwhile.
class PlanServer {
 public:
  /// @param private_nh the node's own namespace.
  /// @param loop,planner,telemetry,offsets must outlive this object.
  PlanServer(const ros::NodeHandle& private_nh, const ControlLoop& loop, Planner& planner, Telemetry& telemetry,
             const OffsetStore& offsets);
  ~PlanServer();

 private:
  std::shared_ptr<const PlannedJob> planOf(const flute_grinder::GrindGoal& goal, const Axes& offset);
  bool onPlan(flute_grinder::Plan::Request& request, flute_grinder::Plan::Response& response);

  const ControlLoop& loop_;
  Planner& planner_;
  Telemetry& telemetry_;
  const OffsetStore& offsets_;
  std::shared_ptr<PlanControl> control_;
  ros::CallbackQueue queue_;
  ros::ServiceServer service_;
  ros::AsyncSpinner spinner_;  ///< last member, so that no call is running when the others are destroyed
};

}  // namespace grinder
