#pragma once

#include <actionlib_msgs/GoalID.h>

#include <functional>
#include <mutex>

namespace flute_grinder {

/// Decides between a stop and the start of a job: ahead of the start a cancel prevents it and a hold has the job begin
/// held; what comes later is for the control loop. Thread safe; its lock is held for some instructions only.
class JobGate {
 public:
  /// A goal has been taken up, and is the one that stops are meant for.
  /// @param give_up called once if it is to be given up ahead of its start, in the thread that asks for it; must not
  ///        wait.
  /// @return false if the gate is shut.
  bool open(const actionlib_msgs::GoalID& goal, std::function<void()> give_up);

  /// Starts the goal's job unless it is to be given up.
  /// @param start hands the job to the control loop; told whether the job is to begin held. Must not wait.
  /// @return whether it was called.
  bool start(const std::function<void(bool held)>& start);

  /// The goal has ended.
  void close();

  /// Takes a cancel, with actionlib's meaning: no id and no stamp is for every goal, a stamp for all that were sent up
  /// to it.
  /// @return whether it is for the control loop: the job has been started, or no goal is named.
  bool cancel(const actionlib_msgs::GoalID& what);

  /// Has a job that has not been started begin held. @return whether there is one.
  bool hold();
  /// Takes that back. @return whether there was something to take back.
  bool resume();

  /// Gives up the goal if its job has not been started, and keeps every other from starting, for good.
  void shut();

  bool canceled() const;  ///< whether the goal is to be given up, or its job is being canceled

 private:
  enum class Phase { kIdle, kAhead, kStarted };

  void giveUp();

  mutable std::mutex mutex_;  ///< guards all below
  Phase phase_ = Phase::kIdle;
  actionlib_msgs::GoalID goal_;
  std::function<void()> give_up_;
  bool canceled_ = false;
  bool held_ = false;
  bool shut_ = false;
};

}  // namespace flute_grinder
