#pragma once

#include "flute_grinder/GrindActionFeedback.h"
#include "flute_grinder/GrindActionResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Plan.h"
#include "flute_grinder/connection/service_call.h"
#include "flute_grinder/core/axes.h"
#include "flute_grinder/core/machine_state.h"

#include <actionlib/goal_id_generator.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>

namespace flute_grinder {

/// What is known of a grinder.
struct GrinderView {
  std::optional<GrinderState> state;      ///< nothing where the grinder has not told it for a second
  std::optional<GrindFeedback> feedback;  ///< of the job that runs, whoever has sent it, or of the last one
  std::optional<double> planned;  ///< part of a goal that is planned and checked, 0..1; nothing where none is planned
  std::optional<Axes> position;   ///< as the drive reads it [m], A [rad]; nothing where it has not come for a second
};

/// A grinder's node as a screen needs it: what it tells, and requests to it. No function waits; answers come by
/// deliver(), in the thread that calls it. The action's topics are read and written as they are, since jobs that others
/// have sent are shown and canceled too. All of it is for one thread.
class GrinderLink {
 public:
  /// @param refusal why not; empty where it was done.
  using OnAnswer = std::function<void(const std::string& refusal)>;
  using OnPlan = std::function<void(const Plan::Response& plan)>;
  /// @param id of the goal, as send() gives it.
  using OnResult = std::function<void(const std::string& id, const GrindResult& result)>;

  /// @param node name of the grinder's node; one without a slash in front is looked for in this program's namespace.
  /// @param on_result called when a goal ends that was sent here, or the job that the view shows.
  /// @throw ros::InvalidNameException
  GrinderLink(const std::string& node, OnResult on_result);
  GrinderLink(const GrinderLink&) = delete;
  GrinderLink& operator=(const GrinderLink&) = delete;
  ~GrinderLink();

  const std::string& name() const { return nh_.getNamespace(); }  ///< resolved
  GrinderView view() const;

  /// Calls the functions whose answers have come, and those whose answers are overdue. To be called often.
  void deliver();

  /// Asks for any change of the state but a start and the stops.
  void request(MachineEvent event, const OnAnswer& on_answer);
  /// @param fraction of the job's feed.
  void setFeedOverride(double fraction, const OnAnswer& on_answer);
  /// Generates and checks every setpoint. A grinder that does not answer is told as a reason.
  void plan(const GrindGoal& goal, const OnPlan& on_plan);

  /// Sends a job. @return the goal's id; nothing where no grinder listens.
  std::optional<std::string> send(const GrindGoal& goal);
  /// Holds or cancels the job that runs or is planned, whoever has sent it, or switches the power off. It goes by a
  /// connection that outlives the ROS master, and has no answer: what comes of it is told by the state.
  /// @param event kHold, kCancel or kDisable.
  /// @param on_answer called if no grinder has listened for two seconds; then nothing is sent any more.
  void stop(MachineEvent event, const OnAnswer& on_answer);
  /// Whether there is a connection for that now.
  bool hearsStops() const { return stops_.getNumSubscribers() > 0; }

 private:
  /// A message with the time when it came.
  template <typename Message>
  struct Received {
    Message message;
    ros::SteadyTime time;
  };

  /// A stop that waits for a connection.
  struct Unsent {
    MachineEvent event;
    ros::SteadyTime due;
    OnAnswer on_answer;
  };

  void sendStops();
  void onState(const GrinderState::ConstPtr& state);
  void onFeedback(const GrindActionFeedback::ConstPtr& feedback);
  void onResult(const GrindActionResult::ConstPtr& result);
  void onJointState(const sensor_msgs::JointState::ConstPtr& joints);
  void post(std::function<void()> answer);
  template <typename Service, typename OnResponse>
  void call(const std::string& service, const typename Service::Request& request, double timeout,
            OnResponse on_response);
  std::string noAnswer() const { return "no answer from the grinder " + name(); }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  const OnResult on_result_;
  actionlib::GoalIDGenerator ids_;

  mutable std::mutex mutex_;  ///< guards what the callbacks bring
  std::optional<Received<GrinderState>> state_;
  std::optional<Received<Axes>> position_;
  std::optional<Received<GrindActionFeedback>> feedback_;
  std::string sent_;  ///< id of the last goal from here
  std::deque<std::function<void()>> answers_;

  ros::Publisher goals_, stops_;
  std::deque<Unsent> unsent_;
  std::list<ros::Subscriber> subscribers_;
  ros::AsyncSpinner spinner_;
  std::list<ServiceCall> calls_;  ///< last, so that none answers any more when the rest goes
};

}  // namespace flute_grinder
