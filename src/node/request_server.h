#pragma once

#include "flute_grinder/ConfirmSwivel.h"
#include "flute_grinder/Jog.h"
#include "flute_grinder/JogStep.h"
#include "flute_grinder/control/control_loop.h"
#include "node/job_gate.h"
#include "node/offset_server.h"
#include "node/served_queue.h"

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <vector>

namespace grinder {

/// Serves the operator's requests other than stops and jobs: a service for each trigger of kMachineEvents, the services
/// `~confirm_swivel` and `~jog_step`, and the topics `~jog` and `~jog_refusal`. Runs in its own thread, which waits for
/// the control loop's reply, one request at a time.
class RequestServer {
 public:
  /// @param loop,gate,offsets must outlive this object.
  RequestServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, OffsetServer& offsets);

 private:
  void serve(ros::NodeHandle& nh, MachineEvent event);
  RequestReply execute(MachineEvent event);
  bool onConfirmSwivel(flute_grinder::ConfirmSwivel::Request& request,
                       flute_grinder::ConfirmSwivel::Response& response);
  bool onJogStep(flute_grinder::JogStep::Request& request, flute_grinder::JogStep::Response& response);
  void onJog(const flute_grinder::Jog::ConstPtr& message);
  void reportJogRefusal(const std::string& refusal);

  ControlLoop& loop_;
  JobGate& gate_;
  OffsetServer& offsets_;
  ServedQueue thread_;
  std::vector<ros::ServiceServer> services_;
  ros::Subscriber jogs_;
  ros::Publisher jog_refusals_;
  ros::SteadyTime last_jog_;  ///< time of the last message of a continuous jog
  bool jog_refused_ = false;  ///< the last message was refused
};

}  // namespace grinder
