#include "panel/grinder_link.h"

#include "flute_grinder/Jog.h"
#include "flute_grinder/JogStep.h"
#include "flute_grinder/Reclamped.h"
#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/SetOffset.h"
#include "flute_grinder/Stop.h"
#include "flute_grinder/TouchOff.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/network/user_at_host.h"

#include <std_srvs/Trigger.h>

#include <algorithm>
#include <utility>

namespace grinder {

namespace {

const ros::WallDuration kStale(1);  ///< age of a lost message; state and positions arrive at 10 Hz or more

constexpr const char* kPlanning = "planning";  ///< state in the feedback until the job runs

constexpr double kRequestTimeout = 10;  ///< longest wait for an answer [s]

/// How long a stop waits for a connection: longer than reconnecting takes once grinder or master are back.
const ros::WallDuration kStopTimeout(2);

flute_grinder::Stop stopFor(MachineEvent event) {
  flute_grinder::Stop stop;
  stop.request = event == MachineEvent::kHold     ? flute_grinder::Stop::HOLD
                 : event == MachineEvent::kCancel ? flute_grinder::Stop::CANCEL
                                                  : flute_grinder::Stop::DISABLE;
  return stop;
}

template <typename Message>
bool isFresh(const std::optional<Message>& received) {
  return received && ros::SteadyTime::now() - received->time <= kStale;
}

}  // namespace

GrinderLink::GrinderLink(const std::string& node, OnResult on_result, OnJogRefusal on_jog_refusal)
    : nh_(node), on_result_(std::move(on_result)), on_jog_refusal_(std::move(on_jog_refusal)), spinner_(1, &queue_) {
  nh_.setCallbackQueue(&queue_);
  ros::NodeHandle around(ros::names::parentNamespace(nh_.getNamespace()));
  around.setCallbackQueue(&queue_);
  const auto hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(nh_.subscribe("machine", 1, &GrinderLink::onMachine, this, hints));
  subscribers_.push_back(nh_.subscribe("state", 10, &GrinderLink::onState, this, hints));
  subscribers_.push_back(nh_.subscribe("grind/feedback", 10, &GrinderLink::onFeedback, this, hints));
  subscribers_.push_back(nh_.subscribe("job", 1, &GrinderLink::onJob, this, hints));
  results_ = nh_.subscribe("grind/result", 10, &GrinderLink::onResult, this, hints);
  subscribers_.push_back(nh_.subscribe("jog_refusal", 10, &GrinderLink::onJogRefusal, this, hints));
  subscribers_.push_back(nh_.subscribe("offsets", 10, &GrinderLink::onOffsets, this, hints));
  subscribers_.push_back(nh_.subscribe("legend", 10, &GrinderLink::onLegend, this, hints));
  subscribers_.push_back(around.subscribe("joint_states", 10, &GrinderLink::onJointState, this, hints));
  goals_ = nh_.advertise<flute_grinder::GrindActionGoal>("grind/goal", 10);
  stops_ = nh_.advertise<flute_grinder::Stop>("stop", 10);
  jogs_ = nh_.advertise<flute_grinder::Jog>("jog", 1);
  spinner_.start();
}

GrinderLink::~GrinderLink() { spinner_.stop(); }

GrinderView GrinderLink::view() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  GrinderView view;
  // Only once the topics of goal and result are connected, or a short job might end unheard.
  if (isFresh(state_) && goals_.getNumSubscribers() > 0 && results_.getNumPublishers() > 0) {
    view.state = state_->message;
    view.machine = machine_;
    view.offsets = offsets_;
    view.legend = legend_;
    if (feedback_) view.feedback = feedback_->message.feedback;
    if (feedback_ && job_ && job_->goal_id.id == feedback_->message.status.goal_id.id) view.job = job_;
  }
  if (isFresh(position_)) view.position = position_->message;
  if (view.position && view.state) {
    const Axes offset = Axes(view.state->position.data()) - Axes(view.state->work_position.data());
    view.work_position = *view.position - offset;
  }
  if (isFresh(feedback_) && view.feedback && view.feedback->state == kPlanning) view.planned = view.feedback->planned;
  return view;
}

void GrinderLink::onMachine(const flute_grinder::MachineInfo::ConstPtr& machine) {
  const std::lock_guard<std::mutex> lock(mutex_);
  machine_ = machine;
}

void GrinderLink::onState(const flute_grinder::GrinderState::ConstPtr& state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  // After a silence the node may be a new process, which knows nothing of the last job.
  if (!isFresh(state_)) feedback_.reset();
  state_ = Received<flute_grinder::GrinderState>{*state, ros::SteadyTime::now()};
}

void GrinderLink::onFeedback(const flute_grinder::GrindActionFeedback::ConstPtr& feedback) {
  const std::lock_guard<std::mutex> lock(mutex_);
  feedback_ = Received<flute_grinder::GrindActionFeedback>{*feedback, ros::SteadyTime::now()};
}

void GrinderLink::onJob(const flute_grinder::GrindActionGoal::ConstPtr& job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  job_ = job;
}

void GrinderLink::onResult(const flute_grinder::GrindActionResult::ConstPtr& result) {
  const std::string& id = result->status.goal_id.id;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool shown = feedback_ && id == feedback_->message.status.goal_id.id;
    if (id != sent_ && !shown) return;
    if (shown) feedback_->message.feedback.state.clear();  // no longer in planning
  }
  post([this, result] { on_result_(result->status.goal_id.id, result->result); });
}

void GrinderLink::onJogRefusal(const std_msgs::String::ConstPtr& refusal) {
  post([this, refusal] { on_jog_refusal_(refusal->data); });
}

void GrinderLink::onOffsets(const flute_grinder::WorkOffsets::ConstPtr& offsets) {
  const std::lock_guard<std::mutex> lock(mutex_);
  offsets_ = *offsets;
}

void GrinderLink::onLegend(const flute_grinder::Legend::ConstPtr& legend) {
  const std::lock_guard<std::mutex> lock(mutex_);
  legend_.reset();
  if (legend->cutter.end_diameter > 0) legend_ = *legend;
}

void GrinderLink::onJointState(const sensor_msgs::JointState::ConstPtr& joints) {
  Axes position;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const auto& names = joints->name;
    const auto joint = std::find(names.begin(), names.end(), kJointNames[static_cast<std::size_t>(axis)]);
    const auto at = static_cast<std::size_t>(joint - names.begin());
    if (joint == names.end() || at >= joints->position.size()) return;  // message about another part of the machine
    position[axis] = joints->position[at];
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  position_ = Received<Axes>{position, ros::SteadyTime::now()};
}

void GrinderLink::post(std::function<void()> answer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  answers_.push_back(std::move(answer));
}

void GrinderLink::deliver() {
  sendStops();
  for (ServiceCall& call : calls_) call.abortIfOverdue();
  calls_.remove_if([](const ServiceCall& call) { return call.finished(); });
  std::deque<std::function<void()>> answers;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    answers.swap(answers_);
  }
  for (const auto& answer : answers) answer();
}

template <typename Service, typename OnResponse>
void GrinderLink::call(const std::string& service, const typename Service::Request& request, double timeout,
                       OnResponse on_response) {
  const auto on_answer = [this, on_response](ros::SerializedMessage* answer) {
    const auto response = responseFrom<Service>(answer);
    post([on_response, response] { on_response(response); });
  };
  calls_.emplace_back(nh_.resolveName(service), ros::service_traits::md5sum<Service>(),
                      ros::serialization::serializeMessage(request), ros::WallDuration(timeout), on_answer);
}

template <typename Service>
void GrinderLink::ask(const std::string& service, const typename Service::Request& request, const std::string& name,
                      const std::string& refused, const OnAnswer& on_answer) {
  call<Service>(service, request, kRequestTimeout,
                [name, refused, on_answer, silence = noAnswer()](const auto& response) {
                  if (!response) return on_answer(name + ": " + silence);
                  on_answer(response->success ? "" : refused + response->message);
                });
}

void GrinderLink::request(MachineEvent event, const OnAnswer& on_answer) {
  ask<std_srvs::Trigger>(serviceOf(event), {}, toString(event), "", on_answer);
}

void GrinderLink::setFeedOverride(double fraction, const OnAnswer& on_answer) {
  flute_grinder::SetFeedOverride::Request request;
  request.fraction = fraction;
  ask<flute_grinder::SetFeedOverride>("set_feed_override", request, "feed override", "", on_answer);
}

void GrinderLink::sayReclamped(const OnAnswer& on_answer) {
  flute_grinder::Reclamped::Request request;
  request.set_by = userAtHost();
  ask<flute_grinder::Reclamped>("reclamped", request, "reclamped", "reclamped: ", on_answer);
}

void GrinderLink::touchOff(
    int axis, double position, const OffsetBasis& basis, const std::vector<std::string>& answers,
    const std::function<void(const std::string& refusal, const std::vector<flute_grinder::Need>& needs)>& on_answer) {
  flute_grinder::TouchOff::Request request;
  request.axis = static_cast<std::uint8_t>(axis);
  request.position = position;
  request.set_by = userAtHost();
  request.basis = toMessage(basis);
  request.answers = answers;
  call<flute_grinder::TouchOff>(
      "touch_off", request, kRequestTimeout, [on_answer, silence = noAnswer()](const auto& response) {
        if (!response) return on_answer("touch-off: " + silence, {});
        on_answer(response->success ? "" : "touch-off: " + response->message, response->needs);
      });
}

void GrinderLink::setOffset(int axis, double value, const OffsetBasis& basis, const OnAnswer& on_answer) {
  flute_grinder::SetOffset::Request request;
  request.axis = static_cast<std::uint8_t>(axis);
  request.value = value;
  request.set_by = userAtHost();
  request.basis = toMessage(basis);
  request.answers = {toString(NeedAnswer::kSetOffset)};
  ask<flute_grinder::SetOffset>("set_offset", request, "set-offset", "set-offset: ", on_answer);
}

void GrinderLink::jogStep(int axis, double distance, double speed, const OnAnswer& on_answer) {
  flute_grinder::JogStep::Request request;
  request.axis = static_cast<std::uint8_t>(axis);
  request.distance = distance;
  request.speed = speed;
  ask<flute_grinder::JogStep>("jog_step", request, "jog", "", on_answer);
}

void GrinderLink::jog(int axis, double velocity) {
  flute_grinder::Jog message;
  const ros::WallTime now = ros::WallTime::now();  // rviz may take its time from a simulation
  message.header.stamp = ros::Time(now.sec, now.nsec);
  message.axis = static_cast<std::uint8_t>(axis);
  message.velocity = velocity;
  jogs_.publish(message);
}

std::optional<std::string> GrinderLink::send(const flute_grinder::GrindGoal& goal) {
  if (goals_.getNumSubscribers() == 0) return std::nullopt;
  flute_grinder::GrindActionGoal message;
  message.header.stamp = ros::Time::now();
  message.goal_id = ids_.generateID();
  message.goal = goal;
  message.goal.sent_by = userAtHost();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    sent_ = message.goal_id.id;
  }
  goals_.publish(message);
  return message.goal_id.id;
}

void GrinderLink::stop(MachineEvent event, const OnAnswer& on_answer) {
  unsent_.push_back({event, ros::SteadyTime::now() + kStopTimeout, on_answer});
  sendStops();
}

void GrinderLink::sendStops() {
  while (!unsent_.empty()) {
    const Unsent stop = unsent_.front();
    const bool connected = stopsConnected();
    if (!connected && ros::SteadyTime::now() < stop.due) return;
    unsent_.pop_front();
    if (connected) {
      stops_.publish(stopFor(stop.event));
      stop.on_answer("");
    } else {
      stop.on_answer(toString(stop.event) + (" was not sent: the grinder " + name()) + " is not connected");
    }
  }
}

}  // namespace grinder
