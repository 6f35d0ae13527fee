#pragma once

#include "flute_grinder/GrindActionFeedback.h"
#include "flute_grinder/GrindActionGoal.h"
#include "flute_grinder/GrindActionResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Legend.h"
#include "flute_grinder/MachineInfo.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/job/axes.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/motion/work_offsets.h"
#include "flute_grinder/network/service_call.h"

#include <actionlib/goal_id_generator.h>
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

namespace grinder {

/// The known state of a grinder.
struct GrinderView {
  std::optional<flute_grinder::GrinderState> state;  ///< nothing if none was received for a second
  /// Of the running job, whoever sent it, or of the last one; nothing without the state, and after it was missing.
  std::optional<flute_grinder::GrindFeedback> feedback;
  flute_grinder::GrindActionGoal::ConstPtr job;  ///< of that feedback, once it has started; may be null
  std::optional<double> planned;  ///< fraction of a goal planned and checked, 0..1; nothing if none is in planning
  /// Of the machine, as read by the drive [m], A [rad]; nothing if none was received for a second.
  std::optional<Axes> position;
  /// The same in work coordinates; NaN of an axis whose work offset is unknown. Nothing without the state.
  std::optional<Axes> work_position;
  std::optional<flute_grinder::WorkOffsets> offsets;  ///< nothing without the state
  flute_grinder::MachineInfo::ConstPtr machine;       ///< null without the state
  std::optional<flute_grinder::Legend>
      legend;  ///< of the job that rviz shows; nothing without one, and without the state
};

/// Client of a grinder's node for a user interface. No function blocks; deliver() calls the callbacks. It uses the
/// action's topics directly, to show and cancel jobs sent by others too. Not thread safe.
class GrinderLink {
 public:
  /// @param refusal why not; empty if it was done.
  using OnAnswer = std::function<void(const std::string& refusal)>;
  /// @param id of the goal, as returned by send().
  using OnResult = std::function<void(const std::string& id, const flute_grinder::GrindResult& result)>;

  /// @param text why a continuous jog, from here or elsewhere, moves nothing.
  using OnJogRefusal = std::function<void(const std::string& text)>;

  /// @param node name of the grinder's node; without a leading slash, relative to this program's namespace.
  /// @param on_result called when a goal sent here, or the job shown, ends.
  /// @throw ros::InvalidNameException
  GrinderLink(const std::string& node, OnResult on_result, OnJogRefusal on_jog_refusal);
  GrinderLink(const GrinderLink&) = delete;
  GrinderLink& operator=(const GrinderLink&) = delete;
  ~GrinderLink();

  const std::string& name() const { return nh_.getNamespace(); }  ///< resolved
  GrinderView view() const;

  /// Calls the callbacks of requests that were answered or timed out. To be called often.
  void deliver();

  /// Requests any state change other than a start or a stop.
  void request(MachineEvent event, const OnAnswer& on_answer);
  /// @param fraction of the job's feed.
  void setFeedOverride(double fraction, const OnAnswer& on_answer);
  /// Confirms the swivel angle set by hand. @param angle [rad].
  void confirmSwivel(double angle, const OnAnswer& on_answer);
  /// Confirms that the wheel of a job is on the spindle.
  void confirmWheel(const OffsetBasis& job, const OnAnswer& on_answer);
  /// Says that a tool was clamped.
  void sayReclamped(const OnAnswer& on_answer);
  /// Sets an axis' work offset from where it stands. @param position in work coordinates [m], A [rad].
  /// @param basis what it is set for. @param large_change_ok it may change by any amount.
  /// @param on_answer as OnAnswer, and whether it was refused because it would change by much.
  void touchOff(int axis, double position, const OffsetBasis& basis, bool large_change_ok,
                const std::function<void(const std::string& refusal, bool large_change)>& on_answer);
  /// Sets an axis' work offset, however much it changes. @param value [m], A [rad].
  void setOffset(int axis, double value, const OffsetBasis& basis, const OnAnswer& on_answer);
  /// Moves an axis by a distance. @param distance signed [m], A [rad]. @param speed [m/s], A [rad/s].
  void jogStep(int axis, double distance, double speed, const OnAnswer& on_answer);
  /// Moves an axis for as long as this is called again and again, by a connection that survives the ROS master.
  /// @param velocity signed [m/s], A [rad/s]; 0 stops.
  void jog(int axis, double velocity);

  /// Sends a job. @return the goal's id; nothing if no grinder is connected.
  std::optional<std::string> send(const flute_grinder::GrindGoal& goal);
  /// Holds or cancels the running or planned job, whoever sent it, or switches the power off. Uses a connection that
  /// survives the ROS master, and has no answer: the state shows the effect.
  /// @param event kHold, kCancel or kDisable.
  /// @param on_answer called once it is sent, or if no grinder was connected for two seconds; it is then dropped.
  void stop(MachineEvent event, const OnAnswer& on_answer);
  /// Whether stops have a connection now.
  bool stopsConnected() const { return stops_.getNumSubscribers() > 0; }

 private:
  /// A message with its time of arrival.
  template <typename Message>
  struct Received {
    Message message;
    ros::SteadyTime time;
  };

  /// A stop waiting for a connection.
  struct Unsent {
    MachineEvent event;
    ros::SteadyTime due;
    OnAnswer on_answer;
  };

  void sendStops();
  void onMachine(const flute_grinder::MachineInfo::ConstPtr& machine);
  void onState(const flute_grinder::GrinderState::ConstPtr& state);
  void onFeedback(const flute_grinder::GrindActionFeedback::ConstPtr& feedback);
  void onJob(const flute_grinder::GrindActionGoal::ConstPtr& job);
  void onResult(const flute_grinder::GrindActionResult::ConstPtr& result);
  void onJogRefusal(const std_msgs::String::ConstPtr& refusal);
  void onOffsets(const flute_grinder::WorkOffsets::ConstPtr& offsets);
  void onLegend(const flute_grinder::Legend::ConstPtr& legend);
  void onJointState(const sensor_msgs::JointState::ConstPtr& joints);
  void post(std::function<void()> answer);
  template <typename Service, typename OnResponse>
  void call(const std::string& service, const typename Service::Request& request, double timeout,
            OnResponse on_response);
  /// @param name in the answer if none comes. @param refused ahead of the refusal.
  template <typename Service>
  void ask(const std::string& service, const typename Service::Request& request, const std::string& name,
           const std::string& refused, const OnAnswer& on_answer);
  std::string noAnswer() const { return "no answer from the grinder " + name(); }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  const OnResult on_result_;
  const OnJogRefusal on_jog_refusal_;
  actionlib::GoalIDGenerator ids_;

  mutable std::mutex mutex_;  ///< guards what the callbacks write
  flute_grinder::MachineInfo::ConstPtr machine_;
  std::optional<Received<flute_grinder::GrinderState>> state_;
  std::optional<Received<Axes>> position_;
  std::optional<flute_grinder::WorkOffsets> offsets_;
  std::optional<flute_grinder::Legend> legend_;
  std::optional<Received<flute_grinder::GrindActionFeedback>> feedback_;
  flute_grinder::GrindActionGoal::ConstPtr job_;  ///< that was started last
  std::string sent_;                              ///< id of the last goal from here
  std::deque<std::function<void()>> answers_;

  ros::Publisher goals_, stops_, jogs_;
  ros::Subscriber results_;
  std::deque<Unsent> unsent_;
  std::list<ros::Subscriber> subscribers_;
  ros::AsyncSpinner spinner_;
  std::list<ServiceCall> calls_;  ///< last member, so that no call answers when the others are destroyed
};

}  // namespace grinder
