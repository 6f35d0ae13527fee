#pragma once

#include "flute_grinder/GrindActionFeedback.h"
#include "flute_grinder/GrindActionGoal.h"
#include "flute_grinder/GrindActionResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Jog.h"
#include "flute_grinder/JogStep.h"
#include "flute_grinder/Legend.h"
#include "flute_grinder/MachineInfo.h"
#include "flute_grinder/Reclamped.h"
#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/SetOffsets.h"
#include "flute_grinder/Stop.h"
#include "flute_grinder/TouchOff.h"
#include "flute_grinder/WorkOffsets.h"

#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/messages/reasons.h"
#include "panel_fixture.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>
#include <QFileInfo>

#include <mutex>
#include <string>
#include <vector>

namespace grinder {

/// A grinder that is and does what a test wants.
class Stage {
 public:
  Stage() : nh_("cell/stage"), spinner_(4, &queue_) {
    nh_.setCallbackQueue(&queue_);
    machine_ = nh_.advertise<flute_grinder::MachineInfo>("machine", 1, true);
    flute_grinder::MachineInfo able;
    able.homing = able.spindle = able.coolant = 1;
    able.jog_timeout = kPatience * 1e-3;
    publishMachine(able);
    state_topic_ = nh_.advertise<flute_grinder::GrinderState>("state", 10, true);
    feedback_ = nh_.advertise<flute_grinder::GrindActionFeedback>("grind/feedback", 10);
    openResults();
    offsets_ = nh_.advertise<flute_grinder::WorkOffsets>("offsets", 10, true);
    legend_ = nh_.advertise<flute_grinder::Legend>("legend", 10, true);
    job_ = nh_.advertise<flute_grinder::GrindActionGoal>("job", 1, true);
    jog_refusals_ = nh_.advertise<std_msgs::String>("jog_refusal", 10);
    joint_states_ = ros::NodeHandle("cell").advertise<sensor_msgs::JointState>("joint_states", 10);
    serve<std_srvs::Trigger>(
        "resume", [this](const auto&, auto&) { ++resumes; }, &Stage::resume_hangs);
    for (const bool on : {true, false}) {
      serve<std_srvs::Trigger>(on ? "spindle_on" : "spindle_off", [this, on](const auto&, auto& response) {
        state.spindle_commanded = on;
        answer(response, "");
      });
    }
    for (const char* name : {"enable", "home", "reset_fault", "retract", "lift", "coolant_on", "coolant_off"}) {
      serve<std_srvs::Trigger>(name, [this, name](const auto&, auto& response) {
        triggers.insert(name);
        answer(response, trigger_refusal);
      });
    }
    serve<flute_grinder::JogStep>("jog_step", [this](const auto& request, auto& response) {
      steps.push_back(request);
      answer(response, step_refusal);
    });
    serve<flute_grinder::TouchOff>("touch_off", [this](const auto& request, auto& response) {
      touches.push_back(request);
      answer(response, touch_refusal);
      response.needs = touch_needs;
    });
    serve<flute_grinder::SetOffsets>("set_offsets", [this](const auto& request, auto& response) {
      offsets_set.push_back(request);
      answer(response, "");
    });
    serve<flute_grinder::SetFeedOverride>("set_feed_override", [this](const auto& request, auto& response) {
      overrides.push_back(request.fraction);
      state.override = request.fraction;
      answer(response, "");
    });
    serve<flute_grinder::Reclamped>("reclamped", [this](const auto& /*request*/, auto& response) {
      ++reclamped;
      answer(response, "");
    });
    goals_ = nh_.subscribe<flute_grinder::GrindActionGoal>("grind/goal", 100, &Stage::onGoal, this);
    jogs_ = listen("jog", jogs);
    stops_ = nh_.subscribe<flute_grinder::Stop>("stop", 10, [this](const flute_grinder::Stop::ConstPtr& stop) {
      change([&] { stops.push_back(stop->request); });
    });
    state.homed = 1;
    state.override = 1;
    state.swivel = 31.769 * M_PI / 180;  // as test/jobs/paper.yaml needs it
    timer_ = nh_.createSteadyTimer(ros::WallDuration(0.05), [this](const ros::SteadyTimerEvent&) { publish(); });
    spinner_.start();
  }
  ~Stage() { release(); }

  void be(std::uint8_t number, const std::string& name) {
    change([&] { state.state = number, state.state_name = name; });
  }
  /// @param name of a state.
  void be(const std::string& name) { be(static_cast<std::uint8_t>(valueOf<MachineState>(name).value()), name); }
  /// The same, until a panel shows it, and with it all that was changed before.
  void be(const std::string& name, Panel& panel) {
    const auto shown = [&panel](const std::string& state) {
      return QString::fromStdString(panel.state()).toLower() == QString::fromStdString(state).replace('_', ' ');
    };
    // What is shown already, or is on its way, tells nothing of the changes.
    const std::string other = name == "disabled" ? "ready" : "disabled";
    be(other);
    WAIT_FOR(shown(other));
    be(name);
    WAIT_FOR(shown(name));
  }
  void standAt(const std::vector<double>& position) {
    change([&] { joints.name = {"axis_x", "axis_y", "axis_z", "axis_a"}, joints.position = position; });
  }
  /// Changes what is public below, while it is not read.
  template <typename Change>
  void change(Change how) {
    const std::lock_guard<std::mutex> lock(mutex_);
    how();
  }
  template <typename Get>
  auto get(Get what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return what();
  }
  /// A copy of a member: get(&Stage::goals).
  template <typename Member>
  Member get(Member Stage::*member) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return this->*member;
  }
  /// Lets a call that hangs come to its end.
  void release() {
    change([&] { resume_hangs = false; });
  }
  void shutResults() { results_.shutdown(); }
  void openResults() { results_ = nh_.advertise<flute_grinder::GrindActionResult>("grind/result", 10); }
  /// Reports the end of a goal.
  void end(const std::string& goal_id, const flute_grinder::GrindResult& result) {
    flute_grinder::GrindActionResult message;
    message.status.goal_id.id = goal_id;
    message.result = result;
    results_.publish(message);
  }
  void publishMachine(const flute_grinder::MachineInfo& machine) { machine_.publish(machine); }
  void publishOffsets(const flute_grinder::WorkOffsets& offsets) { offsets_.publish(offsets); }
  /// The same with the wheel of a goal on the spindle.
  void publishOffsets(flute_grinder::WorkOffsets offsets, const flute_grinder::GrindGoal& goal) {
    const OffsetBasis basis = basisOf(goal, OffsetMethod::kUnknown);
    offsets.wheel.name = basis.wheel_name;
    offsets.wheel.digest = basis.wheel_digest;
    offsets.wheel.diameter = basis.wheel_diameter;
    publishOffsets(offsets);
  }
  /// Reports which goal of somebody else starts, and that the progress is its.
  void publishJob(const flute_grinder::GrindGoal& goal) {
    flute_grinder::GrindActionGoal job;
    job.goal_id.id = "from a terminal";
    job.goal = goal;
    change([&] { goal_id = job.goal_id.id; });
    job_.publish(job);
  }
  /// Has a job in its journal that was left at tooth 2, pass 3. @param operation as of readJobFile().
  void leave(const QString& job, const std::string& operation = "") {
    const std::lock_guard<std::mutex> lock(mutex_);
    state.progress.job_digest = digestOf(job, operation);
    state.progress.job_name = QFileInfo(job).fileName().toStdString();
    state.progress.cutter = goalFromFile(job.toStdString(), operation).cutter;
    state.progress.tooth = 1, state.progress.pass = 2;
  }
  void publishLegend(const flute_grinder::Legend& legend) { legend_.publish(legend); }
  void refuseJog(const std::string& why) {
    std_msgs::String message;
    message.data = why;
    jog_refusals_.publish(message);
  }
  /// Listens to no stop any more.
  void stopListening() { stops_.shutdown(); }

  flute_grinder::GrinderState state;
  flute_grinder::GrindFeedback progress;
  sensor_msgs::JointState joints;
  bool silent = false;
  bool without_feedback = false;
  bool resume_hangs = false;
  bool plan_hangs = false;  ///< whether a dry run has no result
  int resumes = 0;
  Names triggers;               ///< that were asked for
  std::string trigger_refusal;  ///< of what only says so; empty to accept it
  std::vector<double> overrides;
  std::vector<flute_grinder::GrindActionGoal> plans;  ///< dry runs
  std::vector<flute_grinder::GrindActionGoal> goals;  ///< all others
  std::vector<int> stops;
  std::vector<flute_grinder::JogStep::Request> steps;
  std::string step_refusal;
  std::vector<flute_grinder::Jog> jogs;
  std::vector<flute_grinder::TouchOff::Request> touches;
  std::string touch_refusal;
  std::vector<flute_grinder::Need> touch_needs;  ///< what must be answered then
  std::vector<flute_grinder::SetOffsets::Request> offsets_set;
  int reclamped = 0;
  std::string goal_id;                 ///< of the progress
  flute_grinder::GrindResult planned;  ///< of a dry run

 private:
  void onGoal(const flute_grinder::GrindActionGoal::ConstPtr& goal) {
    const std::lock_guard<std::mutex> lock(mutex_);
    (goal->goal.dry_run ? plans : goals).push_back(*goal);
    if (goal->goal.dry_run && !plan_hangs) end(goal->goal_id.id, planned);
  }
  void publish() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (silent) return;
    state_topic_.publish(state);
    flute_grinder::GrindActionFeedback feedback;
    feedback.feedback = progress;
    feedback.status.goal_id.id = goal_id;
    if (!without_feedback) feedback_.publish(feedback);
    joint_states_.publish(joints);
  }
  template <typename Response>
  static void answer(Response& response, const std::string& refusal) {
    response.success = static_cast<std::uint8_t>(refusal.empty());
    response.message = refusal;
  }
  /// Offers a service. @param hangs whether its answers wait.
  template <typename Service, typename Handle>
  void serve(const char* name, Handle handle, bool Stage::*hangs = nullptr) {
    using Request = typename Service::Request;
    using Response = typename Service::Response;
    const boost::function<bool(Request&, Response&)> call = [=](Request& request, Response& response) {
      change([&] { handle(request, response); });
      while (hangs && get(hangs) && ros::ok()) ros::WallDuration(0.01).sleep();
      return true;
    };
    services_.push_back(nh_.advertiseService(name, call));
  }
  template <typename Message>
  ros::Subscriber listen(const char* topic, std::vector<Message>& heard) {
    return nh_.subscribe<Message>(topic, 100, [this, &heard](const boost::shared_ptr<const Message>& message) {
      change([&] { heard.push_back(*message); });
    });
  }

  std::mutex mutex_;
  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  ros::Publisher machine_, state_topic_, feedback_, results_, joint_states_, offsets_, legend_, job_, jog_refusals_;
  std::vector<ros::ServiceServer> services_;
  ros::Subscriber goals_, stops_, jogs_;
  ros::SteadyTimer timer_;
  ros::AsyncSpinner spinner_;  ///< last member, so that no callback runs when the others are destroyed
};

/// What the stage has received, in short words.
class Staged : public ::testing::Test {
 protected:
  std::vector<flute_grinder::GrindActionGoal> goals() { return stage.get(&Stage::goals); }
  std::vector<int> stops() { return stage.get(&Stage::stops); }
  std::vector<flute_grinder::TouchOff::Request> touches() { return stage.get(&Stage::touches); }

  Stage stage;
};

const Need kUnfinished{NeedKind::kUnfinishedJob, "the journal keeps another job", {}, {NeedAnswer::kDiscard}};
const Need kOtherWheel{NeedKind::kWheel,
                       "another wheel is on the spindle",
                       {{"wheel", "w.yaml, D 100 mm", "other.yaml, D 90 mm", ""}},
                       {NeedAnswer::kConfirmWheel}};
const Need kOtherZeros{NeedKind::kOffsets,
                       "Y and Z are of another job",
                       {{"Y", "D 10 mm", "touched off for D 6 mm (other.yaml)", "2 mm"}},
                       {NeedAnswer::kFitOffsets, NeedAnswer::kIgnoreOffsets}};
const Need kNoZeros{
    NeedKind::kOffsets, "X was never set", {{"X", "touched off", "never set", ""}}, {NeedAnswer::kIgnoreOffsets}};
const Need kSwivelToSet{NeedKind::kSwivel,
                        "the swivel is not confirmed",
                        {{"swivel", "31.769 deg", "not known", ""}},
                        {NeedAnswer::kConfirmSwivel}};

/// With a panel that has the paper's job, which can be ground.
class OnStage : public Staged {
 protected:
  OnStage() {
    stage.change([&] { stage.planned.plan.valid = 1; });
    stage.be("ready");
  }
  /// Changes the grinder, and waits until the panel knows: what is reported later shows.
  template <typename Change>
  void publish(Change how) {
    stage.change(how);
    stage.be("lifting", panel);
    stage.be("ready", panel);
  }
  /// Says what a start needs, from the next plan on.
  void need(const std::vector<Need>& needs) {
    stage.change([&] { stage.planned.plan.needs = toMessage(needs); });
  }
  /// Plans and starts the job, until a question has this answer.
  void startAndBeAsked(const char* answer) {
    if (!panel.enabled("start")) panel.plan();
    panel.click("start");
    WAIT_FOR(panel.isVisible(answer));
  }

  Panel panel{"cell/stage", kPaper};
};

}  // namespace grinder
