#pragma once

#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/node/job_gate.h"
#include "flute_grinder/node/served_queue.h"

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <vector>

namespace flute_grinder {

/// Serves the operator's requests other than stops and jobs: a service for each trigger of kMachineEvents. Runs in its
/// own thread, which waits for the control loop's reply, one request at a time.
class RequestDesk {
 public:
  /// @param private_nh the node's own namespace.
  /// @param loop,gate must outlive this object.
  RequestDesk(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate);

 private:
  void serve(ros::NodeHandle& nh, MachineEvent event);
  RequestReply execute(MachineEvent event);

  ControlLoop& loop_;
  JobGate& gate_;
  ServedQueue thread_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace flute_grinder
