#pragma once

#include "flute_grinder/Probe.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/node/job_gate.h"
#include "flute_grinder/node/served_queue.h"

#include <ros/ros.h>

#include <string>

namespace flute_grinder {

/// Serves `~probe`: a series of jogs that end where the measuring probe touches. Runs in its own thread, which waits
/// for the motion; a stop goes to the control loop past it, and ends the series.
class ProbeDesk {
 public:
  /// @param private_nh the node's own namespace.
  /// @param loop,gate must outlive this object.
  ProbeDesk(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate);

 private:
  bool onProbe(Probe::Request& request, Probe::Response& response);

  ControlLoop& loop_;
  JobGate& gate_;
  ServedQueue thread_;
  ros::ServiceServer service_;
};

}  // namespace flute_grinder
