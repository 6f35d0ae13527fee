#include "flute_grinder/node/request_desk.h"

namespace flute_grinder {

RequestDesk::RequestDesk(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate)
    : loop_(loop), gate_(gate) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  for (const EventRow& request : kMachineEvents) {
    if (isTrigger(request.value)) serve(nh, request.value);
  }
  thread_.start();
}

void RequestDesk::serve(ros::NodeHandle& nh, MachineEvent event) {
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> callback =
      [this, event](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        const RequestReply reply = execute(event);
        response.success = reply.accepted;
        response.message = reply.text;
        if (!reply.accepted) ROS_WARN_STREAM(reply.text);
        return true;
      };
  services_.push_back(nh.advertiseService(serviceOf(event), callback));
}

RequestReply RequestDesk::execute(MachineEvent event) {
  // A hold from before the job's start is still in the gate.
  if (event == MachineEvent::kResume && gate_.resume()) return {true, "", true};
  return loop_.request(event);
}

}  // namespace flute_grinder
