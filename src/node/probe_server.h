#pragma once

#include "flute_grinder/Probe.h"
#include "flute_grinder/control/control_loop.h"
#include "node/job_gate.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <atomic>

namespace flute_grinder {

/// Serves `~probe`: a series of jogs that end where the measuring probe touches, for as long as its client repeats
/// `~probe_alive`. Two threads: one waits for the motion, the other takes these messages, and refuses further calls, so
/// that none waits and then moves after a stop. A stop goes to the control loop past them, and ends the series.
class ProbeServer {
 public:
  /// @param private_nh the node's own namespace.
  /// @param loop,gate must outlive this object.
  ProbeServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate);
  ~ProbeServer();

 private:
  bool onProbe(Probe::Request& request, Probe::Response& response);
  void onAlive(const std_msgs::Header::ConstPtr& message);
  void probe(const Probe::Request& request, Probe::Response& response);

  ControlLoop& loop_;
  JobGate& gate_;
  std::atomic<bool> probing_{false};
  ros::CallbackQueue queue_;
  ros::ServiceServer service_;
  ros::Subscriber alive_;
  ros::AsyncSpinner spinner_;  ///< last member, so that no call is running when the others are destroyed
};

}  // namespace flute_grinder
