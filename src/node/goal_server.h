#pragma once

#include "flute_grinder/GrindAction.h"
#include "flute_grinder/control/control_loop.h"
#include "node/action_server.h"
#include "node/job_gate.h"
#include "node/offset_server.h"
#include "node/planner.h"
#include "node/progress_tracker.h"
#include "node/served_queue.h"
#include "node/stop_server.h"
#include "node/telemetry.h"

#include <ros/ros.h>

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Serves the action `~grind`: has each goal planned, enters its job in the journal, starts it, publishes it on `~job`,
/// and reports its end. Runs in its own thread, which never blocks: results from other threads arrive as callbacks or
/// are polled. One goal at a time; any other is rejected at once.
class GoalServer {
 public:
  /// The parameters must outlive this object, except private_nh.
  GoalServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, StopServer& stops, Planner& planner,
             Telemetry& telemetry, Journal& journal, OffsetServer& offsets, const LoopWatchdog& watchdog);
  ~GoalServer();

  /// Whether there is a goal that has not ended. Thread safe.
  bool busy() const { return busy_; }

 private:
  using Server = ActionServer<flute_grinder::GrindAction>;
  using GoalHandle = Server::GoalHandle;

  enum class Phase { kAnswering, kPlanning, kStarting, kJournaling, kRunning };

  /// The goal being processed.
  struct Goal {
    GoalHandle handle;
    ValidJob job;
    std::shared_ptr<PlanControl> control;
    Phase phase = Phase::kAnswering;
    std::future<std::string> answered{};  ///< why an answer was not carried out, once it has been tried
    WorkOffsets offsets{};                ///< those of the plan; from then to the end of the goal they cannot change
    bool swivel_confirmed = false;        ///< an answer confirms the swivel, which the loop is to take with the start
    std::vector<Need> needs{};            ///< what a start needs and the goal does not answer
    std::shared_ptr<const PlannedJob> plan{};
    std::unique_ptr<SetpointStream> stream{};  ///< setpoints of the goal's job
    std::uint64_t number = 0;                  ///< the loop's number for the goal's job
    std::string journal_error{};               ///< why the job could not be entered in the journal
    ros::SteadyTime ended{};                   ///< time at which the loop was seen to have finished the job
    ros::SteadyTime last_feedback{};           ///< time of the last feedback while planning
  };

  void onGoal(GoalHandle handle);
  void onCancel(const GoalHandle& handle);
  std::string refusal(const flute_grinder::GrindGoal& goal, const std::string& digest) const;
  std::vector<Need> needsOf(const Goal& goal, const WorkOffsets& offsets) const;
  void begin(const GoalHandle& handle, const ValidJob& job);
  void carryOutAnswers();
  void takeAnswered();
  void plan(const WorkOffsets& offsets);
  void onPlanned(std::shared_ptr<const PlannedJob> planned);
  void poll();
  void publishFeedback();
  void publishPlanningFeedback();
  void startJob();
  void publishJob();
  void checkStartReply();
  void releaseWhenJournaled();
  void endWhenPublished();
  void endJob();
  flute_grinder::GrindResult resultOfPlan(const PlannedJob& plan) const;
  flute_grinder::GrindResult resultOfJob(const LoopStatus& status) const;
  void cancelBeforeStart();
  void abortGoal(const std::string& text);
  void rollBack();
  flute_grinder::GrindResult resultOf(const std::vector<Need>& needs) const;
  void refuse(const flute_grinder::GrindResult& result);
  void reject(GoalHandle& handle, int code, const std::string& text);
  void reject(GoalHandle& handle, const flute_grinder::GrindResult& result);
  void release();

  ControlLoop& loop_;
  JobGate& gate_;
  Planner& planner_;
  Telemetry& telemetry_;
  OffsetServer& offsets_;
  const LoopWatchdog& watchdog_;
  ProgressTracker tracker_;

  std::optional<Goal> goal_;
  std::atomic<bool> busy_{false};
  /// Its queue serves the callbacks of the members below. A cancel on its way in another thread may still know it.
  const std::shared_ptr<ServedQueue> thread_;
  ros::Publisher job_;  ///< the goal about to start, because a recorder may connect to its sender too late
  std::unique_ptr<Server> server_;
  ros::Subscriber cancels_;
};

}  // namespace grinder
