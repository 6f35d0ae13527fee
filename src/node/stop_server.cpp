#include "node/stop_server.h"

#include <sstream>

namespace grinder {

StopServer::StopServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate) : loop_(loop), gate_(gate) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  services_.push_back(nh.advertiseService(serviceOf(MachineEvent::kHold), &StopServer::onHold, this));
  services_.push_back(nh.advertiseService(serviceOf(MachineEvent::kDisable), &StopServer::onDisable, this));
  services_.push_back(nh.advertiseService("set_feed_override", &StopServer::onFeedOverride, this));
  const auto hints = ros::TransportHints().tcpNoDelay();
  // In addition to actionlib, which blocks on publishing, and forwards only the first cancel of a goal.
  subscribers_.push_back(nh.subscribe("grind/cancel", 50, &StopServer::onCancel, this, hints));
  subscribers_.push_back(nh.subscribe("stop", 50, &StopServer::onStop, this, hints));
  thread_.start();
}

bool StopServer::onHold(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  if (gate_.hold()) {
    loop_.postStop(MachineEvent::kHold);  // an axis may be jogged while the job is planned
    response.success = true;
    response.message = "the job will be held before it moves";
    return true;
  }
  const RequestReply reply = loop_.stop(MachineEvent::kHold);
  response.success = reply.accepted;
  response.message = reply.text;
  return true;
}

bool StopServer::onDisable(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  gate_.cancel(actionlib_msgs::GoalID());
  const RequestReply reply = loop_.stop(MachineEvent::kDisable);
  response.success = reply.accepted;
  response.message = reply.text;
  return true;
}

bool StopServer::onFeedOverride(flute_grinder::SetFeedOverride::Request& request,
                                flute_grinder::SetFeedOverride::Response& response) {
  response.success = loop_.setFeedOverride(request.fraction);
  if (!response.success) {
    std::ostringstream text;
    text << "feed override = " << request.fraction << "; allowed: 0 to " << kMaxFeedOverride;
    response.message = text.str();
  }
  return true;
}

void StopServer::onCancel(const actionlib_msgs::GoalID::ConstPtr& what) {
  if (gate_.cancel(*what)) loop_.postStop(MachineEvent::kCancel);
}

void StopServer::onStop(const flute_grinder::Stop::ConstPtr& stop) {
  switch (stop->request) {
    case flute_grinder::Stop::HOLD:
      static_cast<void>(gate_.hold());
      loop_.postStop(MachineEvent::kHold);  // an axis may be jogged while a job is planned
      break;
    case flute_grinder::Stop::CANCEL:
    case flute_grinder::Stop::DISABLE:
      gate_.cancel(actionlib_msgs::GoalID());
      loop_.postStop(stop->request == flute_grinder::Stop::CANCEL ? MachineEvent::kCancel : MachineEvent::kDisable);
      break;
    default: break;  // from a newer sender; its meaning is unknown
  }
}

}  // namespace grinder
