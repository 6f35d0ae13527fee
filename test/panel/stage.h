#pragma once

#include "flute_grinder/ConfirmSwivel.h"
#include "flute_grinder/GrindActionFeedback.h"
#include "flute_grinder/GrindActionGoal.h"
#include "flute_grinder/GrindActionResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Jog.h"
#include "flute_grinder/JogStep.h"
#include "flute_grinder/Legend.h"
#include "flute_grinder/MachineInfo.h"
#include "flute_grinder/Plan.h"
#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/SetOffset.h"
#include "flute_grinder/Stop.h"
#include "flute_grinder/TouchOff.h"
#include "flute_grinder/WorkOffsets.h"

#include "flute_grinder/machine/machine_state.h"
#include "panel_fixture.h"

#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <mutex>
#include <string>
#include <vector>

namespace grinder {

/// A grinder that is and does what a test wants.
class Stage {
 public:
  Stage() : nh_("cell/stage") {
    machine_ = nh_.advertise<flute_grinder::MachineInfo>("machine", 1, true);
    flute_grinder::MachineInfo able;
    able.homing = able.spindle = able.coolant = 1;
    publishMachine(able);
    state_topic_ = nh_.advertise<flute_grinder::GrinderState>("state", 10, true);
    feedback_ = nh_.advertise<flute_grinder::GrindActionFeedback>("grind/feedback", 10);
    openResults();
    offsets_ = nh_.advertise<flute_grinder::WorkOffsets>("offsets", 10, true);
    legend_ = nh_.advertise<flute_grinder::Legend>("legend", 10, true);
    job_ = nh_.advertise<flute_grinder::GrindActionGoal>("job", 1, true);
    jog_refusals_ = nh_.advertise<std_msgs::String>("jog_refusal", 10);
    joint_states_ = ros::NodeHandle("cell").advertise<sensor_msgs::JointState>("joint_states", 10);
    services_.push_back(nh_.advertiseService("plan", &Stage::onPlan, this));
    services_.push_back(nh_.advertiseService("resume", &Stage::onResume, this));
    services_.push_back(nh_.advertiseService("lift", &Stage::onLift, this));
    services_.push_back(nh_.advertiseService("spindle_on", &Stage::onSpindleOn, this));
    services_.push_back(nh_.advertiseService("spindle_off", &Stage::onSpindleOff, this));
    for (const char* name : {"enable", "home", "reset_fault", "retract", "coolant_on", "coolant_off"}) {
      services_.push_back(nh_.advertiseService(name, &Stage::onTrigger, this));
    }
    services_.push_back(nh_.advertiseService("jog_step", &Stage::onJogStep, this));
    services_.push_back(nh_.advertiseService("touch_off", &Stage::onTouchOff, this));
    services_.push_back(nh_.advertiseService("set_offset", &Stage::onSetOffset, this));
    services_.push_back(nh_.advertiseService("set_feed_override", &Stage::onOverride, this));
    services_.push_back(nh_.advertiseService("confirm_swivel", &Stage::onConfirmSwivel, this));
    goals_ = nh_.subscribe("grind/goal", 10, &Stage::onGoal, this);
    stops_ = nh_.subscribe("stop", 10, &Stage::onStop, this);
    jogs_ = nh_.subscribe("jog", 100, &Stage::onJog, this);
    state.homed = 1;
    state.override = 1;
    state.swivel = 31.769 * M_PI / 180;  // as test/jobs/paper.yaml needs it
    timer_ = nh_.createSteadyTimer(ros::WallDuration(0.05), [this](const ros::SteadyTimerEvent&) { publish(); });
  }
  ~Stage() { release(); }

  void be(std::uint8_t number, const std::string& name) {
    change([&] { state.state = number, state.state_name = name; });
  }
  /// @param name of a state.
  void be(const std::string& name) { be(static_cast<std::uint8_t>(valueOf<MachineState>(name).value()), name); }
  /// The same, until a panel shows it, and with it all that was changed before.
  void be(const std::string& name, Panel& panel) {
    be(name);
    WAIT_FOR(QString::fromStdString(panel.state()).toLower() == QString::fromStdString(name).replace('_', ' '));
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
    change([&] { resume_hangs = plan_hangs = false; });
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
  /// Reports which goal starts, and that the progress is its.
  void publishJob(const flute_grinder::GrindActionGoal& goal) {
    change([&] { goal_id = goal.goal_id.id; });
    job_.publish(goal);
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
  bool plan_hangs = false;
  int resumes = 0;
  int lifts = 0;
  std::string trigger_refusal;  ///< of enable, home, reset and retract; empty to accept them
  std::string swivel_refusal;   ///< of a confirmation; empty to accept it
  std::vector<double> swivels;
  std::vector<double> overrides;
  std::vector<flute_grinder::GrindGoal> plans;  ///< that were asked for
  std::vector<flute_grinder::GrindActionGoal> goals;
  std::vector<int> stops;
  std::vector<flute_grinder::JogStep::Request> steps;
  std::string step_refusal;
  std::vector<flute_grinder::Jog> jogs;
  std::vector<flute_grinder::TouchOff::Request> touches;
  std::string touch_refusal;
  bool large_change = false;  ///< the reason of that
  std::vector<flute_grinder::SetOffset::Request> offsets_set;
  std::string goal_id;  ///< of the progress
  flute_grinder::Plan::Response plan;

 private:
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
  bool onPlan(flute_grinder::Plan::Request& request, flute_grinder::Plan::Response& response) {
    change([&] { plans.push_back(request.goal); });
    while (get([&] { return plan_hangs; }) && ros::ok()) ros::WallDuration(0.01).sleep();
    change([&] { response = plan; });
    return true;
  }
  bool onResume(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&) {
    change([&] { ++resumes; });
    while (get([&] { return resume_hangs; }) && ros::ok()) ros::WallDuration(0.01).sleep();
    return true;
  }
  bool onLift(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    change([&] { ++lifts; });
    response.success = 1;
    return true;
  }
  bool onSpindleOn(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    change([&] { response.success = state.spindle_commanded = 1; });
    return true;
  }
  bool onSpindleOff(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    change([&] { response.success = 1, state.spindle_commanded = 0; });
    return true;
  }
  bool onTrigger(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    change([&] {
      response.success = static_cast<std::uint8_t>(trigger_refusal.empty());
      response.message = trigger_refusal;
    });
    return true;
  }
  bool onJogStep(flute_grinder::JogStep::Request& request, flute_grinder::JogStep::Response& response) {
    change([&] {
      steps.push_back(request);
      response.success = static_cast<std::uint8_t>(step_refusal.empty());
      response.message = step_refusal;
    });
    return true;
  }
  bool onTouchOff(flute_grinder::TouchOff::Request& request, flute_grinder::TouchOff::Response& response) {
    change([&] {
      touches.push_back(request);
      response.success = static_cast<std::uint8_t>(touch_refusal.empty());
      response.message = touch_refusal;
      response.large_change = static_cast<std::uint8_t>(large_change);
    });
    return true;
  }
  bool onSetOffset(flute_grinder::SetOffset::Request& request, flute_grinder::SetOffset::Response& response) {
    change([&] { offsets_set.push_back(request); });
    response.success = 1;
    return true;
  }
  void onJog(const flute_grinder::Jog::ConstPtr& jog) {
    change([&] { jogs.push_back(*jog); });
  }
  bool onOverride(flute_grinder::SetFeedOverride::Request& request,
                  flute_grinder::SetFeedOverride::Response& response) {
    change([&] { overrides.push_back(request.fraction), state.override = request.fraction; });
    response.success = 1;
    return true;
  }
  bool onConfirmSwivel(flute_grinder::ConfirmSwivel::Request& request,
                       flute_grinder::ConfirmSwivel::Response& response) {
    change([&] {
      swivels.push_back(request.swivel);
      response.success = static_cast<std::uint8_t>(swivel_refusal.empty());
      response.message = swivel_refusal;
      if (response.success) state.swivel = request.swivel;
    });
    return true;
  }
  void onGoal(const flute_grinder::GrindActionGoal::ConstPtr& goal) {
    change([&] { goals.push_back(*goal); });
  }
  void onStop(const flute_grinder::Stop::ConstPtr& stop) {
    change([&] { stops.push_back(stop->request); });
  }

  std::mutex mutex_;
  ros::NodeHandle nh_;
  ros::Publisher machine_, state_topic_, feedback_, results_, joint_states_, offsets_, legend_, job_, jog_refusals_;
  std::vector<ros::ServiceServer> services_;
  ros::Subscriber goals_, stops_, jogs_;
  ros::SteadyTimer timer_;
};

}  // namespace grinder
