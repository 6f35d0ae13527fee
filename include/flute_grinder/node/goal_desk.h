#pragma once

#include "flute_grinder/GrindAction.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/node/bookkeeper.h"
#include "flute_grinder/node/job_gate.h"
#include "flute_grinder/node/planner.h"
#include "flute_grinder/node/served_queue.h"
#include "flute_grinder/node/teller.h"

#include <actionlib/server/action_server.h>
#include <ros/ros.h>

#include <memory>
#include <optional>
#include <string>

namespace flute_grinder {

/// The action `~grind`: takes a goal up, has it planned, enters it in the journal, starts it and ends it. It has a
/// thread of its own, which blocks on nobody: what others are asked for comes back as a callback, or is polled every
/// millisecond. One goal at a time; every other is answered at once.
class GoalDesk {
 public:
  /// @param private_nh the node's own namespace.
  /// @param the rest must outlive this object.
  GoalDesk(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, Planner& planner, Teller& teller,
           JournalKeeper& journal);
  ~GoalDesk() { thread_.stop(); }

  /// Whether there is a goal that has not ended. Thread safe.
  bool busy() const { return busy_; }

 private:
  using Server = actionlib::ActionServer<GrindAction>;
  using GoalHandle = Server::GoalHandle;

  enum class Phase { kPlanning, kEntering, kStarting, kRunning };

  /// The goal that was taken up.
  struct Goal {
    GoalHandle handle;
    std::string digest;
    std::shared_ptr<PlanControl> control;
    Phase phase = Phase::kPlanning;
    std::shared_ptr<const Preview> preview{};
    std::uint64_t number = 0;     ///< of its job, in the loop's count
    ros::SteadyTime ended{};      ///< when the loop was seen to have ended the job
    ros::SteadyTime last_told{};  ///< of the planning
  };

  void onGoal(GoalHandle handle);
  void onCancel(const GoalHandle& handle);
  std::string objection(const GrindGoal& goal, const std::string& digest) const;
  void takeUp(const GoalHandle& handle, const GrindJob& job, const std::string& digest);
  void onPlanned(std::shared_ptr<Preview> preview);
  void poll();
  void tellPlanning();
  void startWhenEntered();
  void awaitStart();
  void endWhenTold();
  void endJob();
  void giveUp();
  void refuseStart(const std::string& text);
  void takeBack();
  void reject(GoalHandle& handle, int code, const std::string& text);
  void reject(GoalHandle& handle, const GrindResult& result);
  void leave();

  ControlLoop& loop_;
  JobGate& gate_;
  Planner& planner_;
  Teller& teller_;
  Bookkeeper books_;

  std::uint64_t cycles_ = 0;    ///< of the loop
  ros::SteadyTime last_cycle_;  ///< when their count was seen to go up
  std::optional<Goal> goal_;
  std::atomic<bool> busy_{false};
  ServedQueue thread_;
  std::unique_ptr<Server> server_;
};

}  // namespace flute_grinder
