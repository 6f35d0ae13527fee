#include "node/request_server.h"

#include "flute_grinder/base/format.h"
#include "node/stamp_age.h"

#include <std_msgs/String.h>

#include <cmath>

namespace grinder {

namespace {

constexpr double kWarningInterval = 1;  ///< time between warnings about the messages of a continuous jog [s]

/// Makes the reply a service's response. @return true, as the service's callback.
template <typename Response>
bool answer(const RequestReply& reply, Response& response) {
  response.success = static_cast<std::uint8_t>(reply.accepted);
  response.message = reply.text;
  if (!reply.accepted) ROS_WARN_STREAM(reply.text);
  return true;
}

/// Why a message of a continuous jog is too old; empty if it is fresh. An interrupted network may deliver old messages.
std::string staleness(const flute_grinder::Jog& message, double timeout) {
  const double age = ageOf(message.header.stamp);
  if (std::abs(age) <= timeout) return "";
  return format(
      "jog refused: the message is %g s old; allowed: up to %g s, by clocks that agree; header.stamp must be set", age,
      timeout);
}

}  // namespace

RequestServer::RequestServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, OffsetServer& offsets)
    : loop_(loop), gate_(gate), offsets_(offsets) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  for (const EventRow& request : kMachineEvents) {
    if (isTrigger(request.value)) serve(nh, request.value);
  }
  services_.push_back(nh.advertiseService("confirm_swivel", &RequestServer::onConfirmSwivel, this));
  services_.push_back(nh.advertiseService("jog_step", &RequestServer::onJogStep, this));
  // Of several waiting messages only the last one counts.
  jogs_ = nh.subscribe("jog", 1, &RequestServer::onJog, this, ros::TransportHints().tcpNoDelay());
  jog_refusals_ = nh.advertise<std_msgs::String>("jog_refusal", 10);
  thread_.start();
}

void RequestServer::serve(ros::NodeHandle& nh, MachineEvent event) {
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> callback =
      [this, event](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        return answer(execute(event), response);
      };
  services_.push_back(nh.advertiseService(serviceOf(event), callback));
}

RequestReply RequestServer::execute(MachineEvent event) {
  // A hold from before the job's start is still in the gate.
  if (event == MachineEvent::kResume && gate_.resume()) return {true, "", true};
  RequestReply reply = loop_.request(event);
  // Noted even if the answer came too late: the loop may be homing.
  if (event == MachineEvent::kHome && (reply.accepted || !reply.answered)) offsets_.noteHoming();
  return reply;
}

bool RequestServer::onConfirmSwivel(flute_grinder::ConfirmSwivel::Request& request,
                                    flute_grinder::ConfirmSwivel::Response& response) {
  return answer(loop_.confirmSwivel(request.swivel), response);
}

bool RequestServer::onJogStep(flute_grinder::JogStep::Request& request, flute_grinder::JogStep::Response& response) {
  JogRequest jog{request.axis, false, request.distance, request.speed};
  const bool named = request.speed != 0 || request.axis >= kAxisCount;
  if (!named) jog.velocity = loop_.config().jog_velocity[request.axis];
  return answer(loop_.jog(jog), response);
}

void RequestServer::onJog(const flute_grinder::Jog::ConstPtr& message) {
  std::string refusal;
  // A message that stops counts however late it comes.
  if (message->velocity != 0) refusal = staleness(*message, loop_.config().jog_timeout);
  if (refusal.empty()) refusal = loop_.jog({message->axis, true, 0, message->velocity}).text;
  reportJogRefusal(refusal);
}

/// Reports a refusal once for each press of a button. @param refusal refusal of the latest message; empty if accepted.
void RequestServer::reportJogRefusal(const std::string& refusal) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const bool pressed_before = (now - last_jog_).toSec() <= loop_.config().jog_timeout;
  const bool reported = jog_refused_ && pressed_before;
  last_jog_ = now;
  jog_refused_ = !refusal.empty();
  if (!jog_refused_) return;
  ROS_WARN_STREAM_THROTTLE(kWarningInterval, refusal);
  if (reported) return;
  std_msgs::String why;
  why.data = refusal;
  jog_refusals_.publish(why);
}

}  // namespace grinder
