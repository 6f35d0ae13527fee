#include "flute_grinder/client/grinder_client.h"

#include "flute_grinder/Jog.h"
#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/Stop.h"
#include "flute_grinder/network/user_at_host.h"

#include <std_srvs/Trigger.h>

#include <algorithm>
#include <utility>

namespace grinder {

namespace {

const ros::WallDuration kStale(1);  ///< age of a lost message; state and positions arrive at 10 Hz or more

constexpr const char* kPlanning = "planning";  ///< state in the feedback until the job runs

const ros::WallDuration kRequestTimeout(10);  ///< longest wait for an answer

/// How long a stop waits for a connection: longer than reconnecting takes once grinder or master are back.
const ros::WallDuration kStopTimeout(2);

ros::NodeHandle withQueue(ros::NodeHandle nh, ros::CallbackQueue& queue) {
  nh.setCallbackQueue(&queue);
  return nh;
}

flute_grinder::Stop stopFor(MachineEvent event) {
  flute_grinder::Stop stop;
  stop.request = event == MachineEvent::kHold     ? flute_grinder::Stop::HOLD
                 : event == MachineEvent::kCancel ? flute_grinder::Stop::CANCEL
                                                  : flute_grinder::Stop::DISABLE;
  return stop;
}

/// Writes the positions of the axes; false for a message about another part of the machine.
bool readPositions(const sensor_msgs::JointState& joints, Axes& position) {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const auto& names = joints.name;
    const auto joint = std::find(names.begin(), names.end(), kJointNames[static_cast<std::size_t>(axis)]);
    const auto at = static_cast<std::size_t>(joint - names.begin());
    if (joint == names.end() || at >= joints.position.size()) return false;
    position[axis] = joints.position[at];
  }
  return true;
}

}  // namespace

GrinderClient::GrinderClient(const std::string& node, OnResult on_result, OnJogRefusal on_jog_refusal,
                             std::function<void()> on_news)
    : nh_(withQueue(ros::NodeHandle(node), queue_)),
      on_result_(std::move(on_result)),
      on_jog_refusal_(std::move(on_jog_refusal)),
      on_news_(std::move(on_news)),
      machine_(nh_, "machine"),
      offsets_(nh_, "offsets", nullptr, on_news_),
      legend_(nh_, "legend"),
      joints_(withQueue(ros::NodeHandle(ros::names::parentNamespace(nh_.getNamespace())), queue_), "joint_states",
              [](const sensor_msgs::JointState& joints) {
                Axes position;
                return readPositions(joints, position);
              }),
      states_(
          nh_, "state", [this](const flute_grinder::GrinderState&) { return forgetAfterSilence(); }, on_news_),
      spinner_(1, &queue_) {
  const auto hints = ros::TransportHints().tcpNoDelay();
  feedbacks_ = nh_.subscribe("grind/feedback", 10, &GrinderClient::onFeedback, this, hints);
  subscribers_.push_back(nh_.subscribe("job", 1, &GrinderClient::onJob, this, hints));
  statuses_ = nh_.subscribe("grind/status", 10, &GrinderClient::onStatuses, this, hints);
  results_ = nh_.subscribe("grind/result", 10, &GrinderClient::onResult, this, hints);
  subscribers_.push_back(nh_.subscribe("jog_refusal", 10, &GrinderClient::onJogRefusal, this, hints));
  goals_ = nh_.advertise<flute_grinder::GrindActionGoal>("grind/goal", 10);
  cancels_ = nh_.advertise<actionlib_msgs::GoalID>("grind/cancel", 10);
  stops_ = nh_.advertise<flute_grinder::Stop>("stop", 10);
  jogs_ = nh_.advertise<flute_grinder::Jog>("jog", 1);
  spinner_.start();
}

GrinderClient::~GrinderClient() {
  queue_.disable();  // or its thread would wait for a message for a tenth of a second more
  spinner_.stop();
}

GrinderView GrinderClient::view() const {
  GrinderView view;
  const std::lock_guard<std::mutex> lock(mutex_);
  // Only once the topics of goal and result are connected, or a short job might end unheard.
  if (states_.isFresh(kStale) && goals_.getNumSubscribers() > 0 && results_.getNumPublishers() > 0) {
    view.state = *states_.newest();
    view.machine = machine_.newest();
    if (const auto offsets = offsets_.newest()) view.offsets = *offsets;
    const auto legend = legend_.newest();
    if (legend && legend->cutter.end_diameter > 0) view.legend = *legend;
    if (feedback_) view.feedback = feedback_->message;
    if (feedback_ && job_ && job_->goal_id.id == feedback_->message->status.goal_id.id) view.job = job_;
  }
  Axes position;
  if (joints_.isFresh(kStale) && readPositions(*joints_.newest(), position)) view.position = position;
  if (view.position && view.state) {
    const Axes offset = Axes(view.state->position.data()) - Axes(view.state->work_position.data());
    view.work_position = *view.position - offset;
  }
  const bool is_new = feedback_ && ros::SteadyTime::now() - feedback_->time <= kStale;
  if (is_new && view.feedback && view.feedback->feedback.state == kPlanning) {
    view.planned = view.feedback->feedback.planned;
  }
  return view;
}

bool GrinderClient::connected() const {
  const auto heard = [](const ros::Subscriber& topic) { return topic.getNumPublishers() > 0; };
  const auto read = [](const ros::Publisher& topic) { return topic.getNumSubscribers() > 0; };
  return states_.newest() && read(goals_) && read(cancels_) && read(stops_) && heard(feedbacks_) && heard(results_) &&
         heard(statuses_);
}

bool GrinderClient::forgetAfterSilence() {
  if (states_.isFresh(kStale)) return true;
  // The node may be a new process, which knows nothing of the last job.
  const std::lock_guard<std::mutex> lock(mutex_);
  feedback_.reset();
  return true;
}

void GrinderClient::onFeedback(const flute_grinder::GrindActionFeedback::ConstPtr& feedback) {
  const std::lock_guard<std::mutex> lock(mutex_);
  feedback_ = Feedback{feedback, ros::SteadyTime::now()};
}

void GrinderClient::onJob(const flute_grinder::GrindActionGoal::ConstPtr& job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  job_ = job;
}

void GrinderClient::onResult(const flute_grinder::GrindActionResult::ConstPtr& result) {
  const std::string& id = result->status.goal_id.id;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool shown = feedback_ && id == feedback_->message->status.goal_id.id;
    if (id != sent_ && !shown) return;
    if (shown) feedback_->time = ros::SteadyTime();  // no longer in planning
    if (id == sent_) sent_.clear();
  }
  post([this, result] { on_result_(*result); });
}

void GrinderClient::onStatuses(const actionlib_msgs::GoalStatusArray::ConstPtr& statuses) {
  const auto is_sent = [this](const actionlib_msgs::GoalStatus& status) { return status.goal_id.id == sent_; };
  flute_grinder::GrindActionResult lost;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto& list = statuses->status_list;
    const bool was_known = std::exchange(known_, std::any_of(list.begin(), list.end(), is_sent));
    // The grinder lists a goal for seconds after its result.
    if (sent_.empty() || known_ || !was_known) return;
    lost.status.goal_id.id = std::exchange(sent_, "");
  }
  lost.status.status = actionlib_msgs::GoalStatus::LOST;
  lost.result.error_code = flute_grinder::GrindResult::LINK_LOST;
  lost.result.error_string = "the grinder no longer knows the job: it has been restarted";
  post([this, lost] { on_result_(lost); });
}

void GrinderClient::onJogRefusal(const std_msgs::String::ConstPtr& refusal) {
  post([this, refusal] { on_jog_refusal_(refusal->data); });
}

void GrinderClient::post(std::function<void()> answer) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    answers_.push_back(std::move(answer));
  }
  on_news_();
}

void GrinderClient::deliver() {
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
void GrinderClient::call(const std::string& service, const typename Service::Request& request, OnResponse on_response) {
  const auto on_answer = [this, on_response](ros::SerializedMessage* answer) {
    const auto response = responseFrom<Service>(answer);
    post([on_response, response] { on_response(response); });
  };
  calls_.emplace_back(nh_.resolveName(service), ros::service_traits::md5sum<Service>(),
                      ros::serialization::serializeMessage(request), kRequestTimeout, on_answer);
}

template <typename Service>
void GrinderClient::ask(const std::string& service, const typename Service::Request& request, const std::string& name,
                        const std::string& refused, const OnAnswer& on_answer) {
  call<Service>(service, request, [name, refused, on_answer, silence = noAnswer()](const auto& response) {
    if (!response) return on_answer(name + ": " + silence);
    on_answer(response->success ? "" : refused + response->message);
  });
}

void GrinderClient::request(MachineEvent event, const OnAnswer& on_answer) {
  ask<std_srvs::Trigger>(serviceOf(event), {}, toString(event), "", on_answer);
}

void GrinderClient::setFeedOverride(double fraction, const OnAnswer& on_answer) {
  flute_grinder::SetFeedOverride::Request request;
  request.fraction = fraction;
  ask<flute_grinder::SetFeedOverride>("set_feed_override", request, "feed override", "", on_answer);
}

void GrinderClient::sayReclamped(const OnAnswer& on_answer) {
  ask<flute_grinder::Reclamped>("reclamped", reclampedRequest(), "reclamped", "reclamped: ", on_answer);
}

void GrinderClient::touchOff(const flute_grinder::TouchOff::Request& request, const OnNeeds& on_answer) {
  call<flute_grinder::TouchOff>("touch_off", request, [on_answer, silence = noAnswer()](const auto& response) {
    if (!response) return on_answer("touch-off: " + silence, {});
    on_answer(response->success ? "" : "touch-off: " + response->message, response->needs);
  });
}

void GrinderClient::setOffsets(const flute_grinder::SetOffsets::Request& request, const OnAnswer& on_answer) {
  ask<flute_grinder::SetOffsets>("set_offsets", request, "set-offsets", "set-offsets: ", on_answer);
}

void GrinderClient::jogStep(const flute_grinder::JogStep::Request& request, const OnAnswer& on_answer) {
  ask<flute_grinder::JogStep>("jog_step", request, "jog", "", on_answer);
}

void GrinderClient::jog(int axis, double velocity) {
  flute_grinder::Jog message;
  const ros::WallTime now = ros::WallTime::now();  // rviz may take its time from a simulation
  message.header.stamp = ros::Time(now.sec, now.nsec);
  message.axis = static_cast<std::uint8_t>(axis);
  message.velocity = velocity;
  jogs_.publish(message);
}

std::optional<std::string> GrinderClient::send(const flute_grinder::GrindGoal& goal) {
  if (goals_.getNumSubscribers() == 0) return std::nullopt;
  flute_grinder::GrindActionGoal message;
  message.header.stamp = ros::Time::now();
  message.goal_id = ids_.generateID();
  message.goal = goal;
  message.goal.sent_by = userAtHost();
  const std::lock_guard<std::mutex> lock(mutex_);  // a cancel follows the goal
  sent_ = message.goal_id.id;
  known_ = false;
  goals_.publish(message);
  return sent_;
}

void GrinderClient::cancelSent() const {
  actionlib_msgs::GoalID id;
  const std::lock_guard<std::mutex> lock(mutex_);
  id.id = sent_;
  if (!sent_.empty()) cancels_.publish(id);  // an empty id would cancel every goal
}

void GrinderClient::stopNow(MachineEvent event) const { stops_.publish(stopFor(event)); }

void GrinderClient::stop(MachineEvent event, const OnAnswer& on_answer) {
  unsent_.push_back({event, ros::SteadyTime::now() + kStopTimeout, on_answer});
  sendStops();
}

void GrinderClient::sendStops() {
  while (!unsent_.empty()) {
    const Unsent stop = unsent_.front();
    const bool connected = stopsConnected();
    if (!connected && ros::SteadyTime::now() < stop.due) return;
    unsent_.pop_front();
    if (connected) {
      stopNow(stop.event);
      stop.on_answer("");
    } else {
      stop.on_answer(toString(stop.event) + (" was not sent: the grinder " + name()) + " is not connected");
    }
  }
}

}  // namespace grinder
