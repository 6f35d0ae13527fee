#include "node/stop_server.h"

#include "flute_grinder/base/format.h"

#include <utility>

namespace grinder {

namespace {

constexpr std::uint32_t kQueue = 50;

}  // namespace

StopServer::StopServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate)
    : nh_(private_nh), loop_(loop), gate_(gate) {
  nh_.setCallbackQueue(thread_.queue());
  services_.push_back(nh_.advertiseService(serviceOf(MachineEvent::kHold), &StopServer::onHold, this));
  services_.push_back(nh_.advertiseService(serviceOf(MachineEvent::kDisable), &StopServer::onDisable, this));
  services_.push_back(nh_.advertiseService("set_feed_override", &StopServer::onFeedOverride, this));
  stops_ = nh_.subscribe("stop", kQueue, &StopServer::onStop, this, ros::TransportHints().tcpNoDelay());
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
    response.message = format("feed override = %g; allowed: 0 to %g", request.fraction, kMaxFeedOverride);
  }
  return true;
}

ros::Subscriber StopServer::subscribeToCancels(std::function<void(const actionlib_msgs::GoalID::Ptr&)> pass_on) {
  const boost::function<void(const actionlib_msgs::GoalID::Ptr&)> cancel = [this, pass_on](const auto& what) {
    if (gate_.cancel(*what)) loop_.postStop(MachineEvent::kCancel);
    pass_on(what);
  };
  return nh_.subscribe<actionlib_msgs::GoalID>("grind/cancel", kQueue, cancel, {}, ros::TransportHints().tcpNoDelay());
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
    default: break;  // an unknown stop, from a newer sender
  }
}

}  // namespace grinder
