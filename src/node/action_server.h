#pragma once

#include <actionlib/server/action_server_base.h>
#include <actionlib_msgs/GoalStatusArray.h>
#include <ros/ros.h>

#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>

namespace grinder {

/// An action server like actionlib::ActionServer, with these differences:
/// - Its owner subscribes to the cancels, which may need another thread: with two subscribers to a topic, roscpp reads
///   an empty message twice, from freed memory.
/// - The result says why a goal was canceled by the stamp of an earlier cancel.
/// - A stamp more than a minute ahead of the system clock counts as the present time: actionlib adds a timeout to it,
///   which throws near the end of ros::Time's range, and a cancel of the future cancels all goals until then.
/// - Ids of more than 1000 bytes, which would be in every status, are ignored, and the status of a cancel that names no
///   known goal ends.
template <typename ActionSpec>
class ActionServer : public actionlib::ActionServerBase<ActionSpec> {
 public:
  using Base = actionlib::ActionServerBase<ActionSpec>;
  using GoalHandle = typename Base::GoalHandle;
  using Result = typename Base::Result;
  using ActionResult = typename Base::ActionResult;

  /// @param nh handle whose queue takes the goals' callbacks. @param name name of the action.
  /// @param recalled completes the result of a goal that was canceled before it was received, if it has no reason yet.
  ActionServer(const ros::NodeHandle& nh, const std::string& name, std::function<void(GoalHandle)> on_goal,
               std::function<void(GoalHandle)> on_cancel, std::function<void(Result&, const std::string&)> recalled)
      : Base(on_goal, on_cancel), nh_(nh, name), recalled_(std::move(recalled)) {}

  /// Takes a message that asks for cancels.
  void cancel(const boost::shared_ptr<actionlib_msgs::GoalID>& id) {
    if (isUsable(*id)) Base::cancelCallback(id);
  }

 private:
  using Lock = boost::recursive_mutex::scoped_lock;
  using Feedback = typename Base::Feedback;
  using ActionFeedback = typename Base::ActionFeedback;
  using ActionGoalPtr = boost::shared_ptr<typename Base::ActionGoal>;

  static constexpr int kQueue = 50;

  void initialize() override {
    results_ = nh_.advertise<ActionResult>("result", kQueue);
    feedback_ = nh_.advertise<ActionFeedback>("feedback", kQueue);
    statuses_ = nh_.advertise<actionlib_msgs::GoalStatusArray>("status", kQueue, true);
    this->status_list_timeout_ = ros::Duration(5);
    timer_ = nh_.createTimer(ros::Duration(0.2), [this](const ros::TimerEvent&) { publishStatus(); });
    goals_ = nh_.subscribe("goal", kQueue, &ActionServer::onGoal, this);
  }

  void onGoal(const ActionGoalPtr& goal) {
    if (isUsable(goal->goal_id)) Base::goalCallback(goal);
  }

  /// Whether actionlib may have this id, with a stamp that it can use.
  static bool isUsable(actionlib_msgs::GoalID& id) {
    constexpr std::size_t longest = 1000;  // [bytes]
    constexpr double ahead = 60;           // longest time ahead of the clock [s]
    const ros::Time now = ros::Time::now();
    if (!(id.stamp.toSec() <= now.toSec() + ahead)) id.stamp = now;
    if (id.id.size() <= longest) return true;
    ROS_WARN_STREAM("a goal's id of " << id.id.size() << " bytes is ignored; allowed: " << longest);
    return false;
  }

  template <typename Message>
  static Message messageOf(const actionlib_msgs::GoalStatus& status) {
    Message message;
    message.header.stamp = ros::Time::now();
    message.status = status;
    return message;
  }

  void publishResult(const actionlib_msgs::GoalStatus& status, const Result& result) override {
    const Lock lock(this->lock_);
    auto message = messageOf<ActionResult>(status);
    message.result = result;
    if (status.status == actionlib_msgs::GoalStatus::RECALLED) recalled_(message.result, reasonOf(status));
    results_.publish(message);
    publishStatus();
  }

  void publishFeedback(const actionlib_msgs::GoalStatus& status, const Feedback& feedback) override {
    const Lock lock(this->lock_);
    auto message = messageOf<ActionFeedback>(status);
    message.feedback = feedback;
    feedback_.publish(message);
  }

  void publishStatus() override {
    const Lock lock(this->lock_);
    actionlib_msgs::GoalStatusArray message;
    message.header.stamp = ros::Time::now();
    for (auto at = this->status_list_.begin(); at != this->status_list_.end();) {
      message.status_list.push_back(at->status_);
      ros::Time& dropped = at->handle_destruction_time_;
      // Of a cancel that names no known goal and has no stamp, as clients send it.
      if (dropped.isZero() && at->handle_tracker_.expired()) dropped = message.header.stamp;
      const bool is_over = !dropped.isZero() && dropped + this->status_list_timeout_ < message.header.stamp;
      at = is_over ? this->status_list_.erase(at) : std::next(at);
    }
    statuses_.publish(message);
  }

  std::string reasonOf(const actionlib_msgs::GoalStatus& status) const {
    const double ahead = (this->last_cancel_ - ros::Time::now()).toSec();
    if (status.text.empty() || !(ahead > 0)) return "canceled before it was received";
    std::ostringstream text;
    text << "a cancel was stamped " << ahead << " s in the future, and cancels every goal until then; allowed: clients "
         << "whose clocks agree";
    return text.str();
  }

  ros::NodeHandle nh_;
  const std::function<void(Result&, const std::string&)> recalled_;
  ros::Publisher results_, feedback_, statuses_;
  ros::Timer timer_;
  ros::Subscriber goals_;
};

}  // namespace grinder
