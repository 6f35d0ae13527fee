#include "node/probe_server.h"

#include "flute_grinder/messages/reasons.h"
#include "node/probing_cycles.h"
#include "node/stamp_age.h"

#include <cmath>

namespace grinder {

ProbeServer::ProbeServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, OffsetServer& offsets)
    : loop_(loop), gate_(gate), offsets_(offsets) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(messages_.queue());
  alive_ = nh.subscribe("probe_alive", 1, &ProbeServer::onAlive, this, ros::TransportHints().tcpNoDelay());
  server_ = std::make_unique<Server>(
      nh, "probe", [this](const GoalHandle& handle) { onGoal(handle); },
      [this](const GoalHandle& handle) { onCancel(handle); },
      [](flute_grinder::ProbeResult& recalled, const std::string& why) {
        if (recalled.message.empty()) recalled.message = why;
      });
  server_->start();
  cancels_ = nh.subscribe("probe/cancel", 50, &Server::cancel, server_.get());
  motion_.start();
  messages_.start();
}

ProbeServer::~ProbeServer() {
  messages_.stop();
  motion_.stop();
}

void ProbeServer::onGoal(GoalHandle handle) {
  const LoopStatus status = loop_.status();
  flute_grinder::ProbeResult result;
  result.message = refusal(*handle.getGoal(), status);
  if (result.message.empty() && !gate_.lockOutJobs()) {
    result.message = "a job is planned or in progress; allowed: after its end";
  }
  if (!result.message.empty()) {
    result.message = "probing refused: " + result.message;
    ROS_WARN_STREAM(result.message);
    return handle.setRejected(result, result.message);
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    goal_ = handle;
  }
  loop_.keepAlive();  // the goal itself shows that the client is alive
  handle.setAccepted();
  motion_.post([this, handle, stops = status.stops] { run(handle, stops); });
}

std::string ProbeServer::refusal(const flute_grinder::ProbeGoal& goal, const LoopStatus& status) const {
  if (isBusy()) return "another probing cycle is in progress; allowed: wait for its end, or cancel it";
  std::string wrong = goalRefusal(goal);
  if (!wrong.empty()) return wrong;
  if (status.state != MachineState::kReady) {
    return std::string("the machine is in state ") + toString(status.state) + "; allowed: ready";
  }
  if (!loop_.config().geometry.probe) return "the machine has no parameter geometry/probe";
  return loop_.capabilities().probe ? "" : "the drive reads no probe";
}

bool ProbeServer::isBusy() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return goal_.has_value();
}

void ProbeServer::onCancel(const GoalHandle& handle) {
  // During the goal no job can start, so the hold cannot stop one.
  const std::lock_guard<std::mutex> lock(mutex_);
  if (goal_ && *goal_ == handle) loop_.postStop(MachineEvent::kHold);
}

void ProbeServer::onAlive(const std_msgs::Header::ConstPtr& message) {
  // An interrupted network may deliver old messages.
  if (std::abs(ageOf(message->stamp)) <= loop_.config().jog_timeout) loop_.keepAlive();
}

void ProbeServer::run(GoalHandle handle, std::uint64_t stops) {
  flute_grinder::ProbeResult result;
  try {
    runUnguarded(handle, stops, result);
  } catch (const std::exception& error) {
    result.message = std::string("probing ended: ") + error.what();
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    goal_.reset();
  }
  gate_.letJobsIn();
  if (result.message.empty()) return handle.setSucceeded(result);
  ROS_WARN_STREAM(result.message);
  const bool canceled = handle.getGoalStatus().status == actionlib_msgs::GoalStatus::PREEMPTING;
  if (canceled) return handle.setCanceled(result, result.message);
  handle.setAborted(result, result.message);
}

void ProbeServer::runUnguarded(GoalHandle& handle, std::uint64_t stops, flute_grinder::ProbeResult& result) {
  const flute_grinder::ProbeGoal& goal = *handle.getGoal();
  Prober prober(loop_, stops, [&](int place, int touch) {
    flute_grinder::ProbeFeedback feedback;
    feedback.place = static_cast<std::uint16_t>(place);
    feedback.touch = static_cast<std::uint16_t>(touch);
    handle.publishFeedback(feedback);
  });
  const WorkOffsets before = offsets_.offsets();
  const double offset = runCycle(prober, goal, before, result);
  if (!goal.set_offset) return;
  prober.checkStop();
  const int axis = rowOf(static_cast<ProbingCycle>(goal.cycle)).axis;
  std::vector<Need> needs;
  const std::string refused = offsets_.setProbed(axis, offset, before, goal, needs);
  result.needs = toMessage(needs);
  result.offset = offset;
  if (!refused.empty()) throw ProbingError(refused);
  result.offset_set = 1;
}

}  // namespace grinder
