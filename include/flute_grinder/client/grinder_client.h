#pragma once

#include "flute_grinder/GrindActionFeedback.h"
#include "flute_grinder/GrindActionGoal.h"
#include "flute_grinder/GrindActionResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Legend.h"
#include "flute_grinder/MachineInfo.h"
#include "flute_grinder/Need.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/base/axes.h"
#include "flute_grinder/client/latest.h"
#include "flute_grinder/client/requests.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/motion/work_offsets.h"
#include "flute_grinder/network/service_call.h"

#include <actionlib/goal_id_generator.h>
#include <actionlib_msgs/GoalStatusArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>

#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The known state of a grinder.
struct GrinderView {
  std::optional<flute_grinder::GrinderState> state;  ///< nothing if none was received for a second
  /// Feedback of the running job of any client, or of the last job; null without the state or after its loss.
  flute_grinder::GrindActionFeedback::ConstPtr feedback;
  flute_grinder::GrindActionGoal::ConstPtr job;  ///< goal of that feedback, once the job has started; may be null
  std::optional<double> planned;  ///< fraction of a goal planned and checked, 0..1; nothing without a goal in planning
  /// Machine position read by the drive [m], A [rad]; nothing if none was received for a second.
  std::optional<Axes> position;
  /// Position in work coordinates [m], A [rad]; NaN for an axis with an unknown work offset. Nothing without the state.
  std::optional<Axes> work_position;
  std::optional<flute_grinder::WorkOffsets> offsets;  ///< nothing without the state
  flute_grinder::MachineInfo::ConstPtr machine;       ///< null without the state
  std::optional<flute_grinder::Legend>
      legend;  ///< legend of the job in rviz; nothing without a job or without the state
};

/// The client of a grinder's node for a user interface. No function blocks; deliver() calls the callbacks. Uses the
/// action's topics directly, to show and cancel the jobs of other clients too. Not thread safe.
class GrinderClient {
 public:
  /// @param refusal why the request was not carried out; empty if it was.
  using OnAnswer = std::function<void(const std::string& refusal)>;
  /// @param needs what must be answered before the request is carried out.
  using OnNeeds = std::function<void(const std::string& refusal, const std::vector<flute_grinder::Need>& needs)>;
  /// @param result with the id of the goal, as returned by send(), and how it ended: LOST, with the reason as its
  /// error, if the grinder no longer knows a goal sent by this object.
  using OnResult = std::function<void(const flute_grinder::GrindActionResult& result)>;
  /// @param text why a continuous jog of any client moves nothing.
  using OnJogRefusal = std::function<void(const std::string& text)>;

  /// @param node name of the grinder's node; without a leading slash, relative to this program's namespace.
  /// @param on_result called when a goal sent by this object, or the job shown, ends.
  /// @param on_news called in another thread when a state, offsets or an answer have come: it is worth to look.
  /// @throw ros::InvalidNameException
  explicit GrinderClient(
      const std::string& node, OnResult on_result = [](const flute_grinder::GrindActionResult&) {},
      OnJogRefusal on_jog_refusal = [](const std::string&) {}, std::function<void()> on_news = [] {});
  GrinderClient(const GrinderClient&) = delete;
  GrinderClient& operator=(const GrinderClient&) = delete;
  ~GrinderClient();

  const std::string& name() const { return nh_.getNamespace(); }  ///< resolved name of the node
  GrinderView view() const;
  /// The states as they come, also without the other topics. Thread safe.
  const Latest<flute_grinder::GrinderState>& states() const { return states_; }
  /// The positions read by the drive, as they come. Thread safe.
  const Latest<sensor_msgs::JointState>& joints() const { return joints_; }
  /// Whether a state has come, and stops, and the action with all its topics, have a connection.
  bool connected() const;

  /// Calls the callbacks of requests that were answered or timed out. To be called often.
  void deliver();

  /// Requests any state change other than a start or a stop.
  void request(MachineEvent event, const OnAnswer& on_answer);
  /// Requests a feed override. @param fraction fraction of the job's feed.
  void setFeedOverride(double fraction, const OnAnswer& on_answer);
  /// Reports that a tool was clamped.
  void sayReclamped(const OnAnswer& on_answer);
  /// Sets the work offset of an axis from its present position.
  void touchOff(const flute_grinder::TouchOff::Request& request, const OnNeeds& on_answer);
  /// Sets work offsets, all of them or none.
  void setOffsets(const flute_grinder::SetOffsets::Request& request, const OnAnswer& on_answer);
  /// Moves an axis by a distance.
  void jogStep(const flute_grinder::JogStep::Request& request, const OnAnswer& on_answer);
  /// Moves an axis for as long as this function is called repeatedly. Uses a connection that survives the ROS master.
  /// @param velocity signed velocity [m/s], A [rad/s]; 0 stops.
  void jog(int axis, double velocity);

  /// Sends a job, in the name of this user. @return the goal's id; nothing if no grinder is connected.
  std::optional<std::string> send(const flute_grinder::GrindGoal& goal);
  /// Cancels the goal that send() has sent last, unless it has ended. Thread safe. Uses a connection that survives the
  /// ROS master.
  void cancelSent() const;
  /// Holds or cancels the running or planned job of any client, or switches the power off. Uses a connection that
  /// survives the ROS master, and has no answer: the state shows the effect.
  /// @param event kHold, kCancel or kDisable.
  /// @param on_answer called once the stop is sent, or when it is dropped after two seconds without a connection.
  void stop(MachineEvent event, const OnAnswer& on_answer);
  /// As stop(), but the stop is lost without a connection. Thread safe.
  void stopNow(MachineEvent event) const;
  /// Whether stops have a connection now.
  bool stopsConnected() const { return stops_.getNumSubscribers() > 0; }

 private:
  /// Feedback with its time of arrival.
  struct Feedback {
    flute_grinder::GrindActionFeedback::ConstPtr message;
    ros::SteadyTime time;
  };

  /// A stop waiting for a connection.
  struct Unsent {
    MachineEvent event;
    ros::SteadyTime due;
    OnAnswer on_answer;
  };

  void sendStops();
  bool forgetAfterSilence();
  void onFeedback(const flute_grinder::GrindActionFeedback::ConstPtr& feedback);
  void onJob(const flute_grinder::GrindActionGoal::ConstPtr& job);
  void onResult(const flute_grinder::GrindActionResult::ConstPtr& result);
  void onStatuses(const actionlib_msgs::GoalStatusArray::ConstPtr& statuses);
  void onJogRefusal(const std_msgs::String::ConstPtr& refusal);
  void post(std::function<void()> answer);
  template <typename Service, typename OnResponse>
  void call(const std::string& service, const typename Service::Request& request, OnResponse on_response);
  /// Calls a service. @param name name of the request, for a missing answer. @param refused text before a refusal.
  template <typename Service>
  void ask(const std::string& service, const typename Service::Request& request, const std::string& name,
           const std::string& refused, const OnAnswer& on_answer);
  std::string noAnswer() const { return "no answer from the grinder " + name(); }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  const OnResult on_result_;
  const OnJogRefusal on_jog_refusal_;
  actionlib::GoalIDGenerator ids_;

  const std::function<void()> on_news_;
  Latest<flute_grinder::MachineInfo> machine_;
  Latest<flute_grinder::WorkOffsets> offsets_;
  Latest<flute_grinder::Legend> legend_;
  Latest<sensor_msgs::JointState> joints_;
  Latest<flute_grinder::GrinderState> states_;

  mutable std::mutex mutex_;  ///< guards the members that the callbacks write
  std::optional<Feedback> feedback_;
  flute_grinder::GrindActionGoal::ConstPtr job_;  ///< goal of the job started last
  std::string sent_;                              ///< id of the last goal sent by this object; empty once it has ended
  bool known_ = false;                            ///< whether the grinder has listed that goal
  std::deque<std::function<void()>> answers_;

  ros::Publisher goals_, cancels_, stops_, jogs_;
  ros::Subscriber feedbacks_, results_, statuses_;
  std::deque<Unsent> unsent_;
  std::list<ros::Subscriber> subscribers_;
  ros::AsyncSpinner spinner_;
  std::list<ServiceCall> calls_;  ///< last member, so that no call answers when the others are destroyed
};

}  // namespace grinder
