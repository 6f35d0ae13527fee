#pragma once

#include <actionlib_msgs/GoalID.h>

#include <functional>
#include <mutex>

namespace grinder {

/// Arbitrates between stops and the start of a job. Before the start, a cancel prevents it and a hold makes the job
/// begin held; later stops go to the control loop. It also keeps a job and a change of its work offsets apart. Thread
/// safe; its lock is held for a few instructions only.
class JobGate {
 public:
  /// Makes a goal the one that stops apply to.
  /// @param give_up called once if the goal is canceled before its start, in the canceling thread; must not block.
  /// @return false if the gate is shut, or while jobs are locked out.
  bool open(const actionlib_msgs::GoalID& goal, std::function<void()> give_up);

  /// Starts the goal's job unless it was canceled.
  /// @param start hands the job to the control loop; its argument says whether to begin held. Must not block.
  /// @return whether `start` was called.
  bool start(const std::function<void(bool held)>& start);

  /// To be called when the goal has ended.
  void close();

  /// Cancels as actionlib defines it: without id and stamp every goal, with a stamp all goals sent up to then.
  /// @return whether the control loop must be stopped: the job has started, or no goal is named.
  bool cancel(const actionlib_msgs::GoalID& what);

  /// Makes a job that has not started begin held. @return whether there is one.
  bool hold();
  /// Undoes hold(). @return whether there was a hold to undo.
  bool resume();

  /// Cancels the goal if its job has not started, and prevents every later start.
  void shut();

  /// Lets no goal in until letJobsIn(); the calls must be paired.
  /// @return false, with nothing changed, if there is a goal already.
  bool lockOutJobs();
  void letJobsIn();

  bool isShut() const;

  bool canceled() const;  ///< whether the goal or its job has been canceled

 private:
  enum class Phase { kIdle, kAhead, kStarted };

  void giveUp();

  mutable std::mutex mutex_;  ///< guards all members below
  Phase phase_ = Phase::kIdle;
  actionlib_msgs::GoalID goal_;
  std::function<void()> give_up_;
  bool canceled_ = false;
  bool held_ = false;
  bool shut_ = false;
  int shut_outs_ = 0;  ///< calls of lockOutJobs() less calls of letJobsIn()
};

}  // namespace grinder
