#include "flute_grinder/node/goal_desk.h"

#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/error_codes.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

namespace flute_grinder {

namespace {

constexpr std::size_t kLongestName = 255;         ///< of a job
constexpr double kPollPeriod = 0.001;             ///< [s]
const ros::WallDuration kPlanningInterval(0.05);  ///< between feedback messages while planning
const ros::WallDuration kLoopTimeout(1);          ///< after which the control loop counts as hung
/// How long the result waits for the last setpoints to be published and the journal to be written.
const ros::WallDuration kEndTimeout(0.5);

GrindResult result(int code, const std::string& text, const PlanStatistics& statistics = {}) {
  GrindResult r;
  r.error_code = code;
  r.error_string = text;
  r.statistics = toMessage(statistics);
  return r;
}

std::string join(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text;
}

/// Control characters are refused, since names are printed on terminals.
bool isName(const std::string& name) {
  const auto controls = [](unsigned char c) { return std::iscntrl(c) != 0; };
  return name.size() <= kLongestName && std::none_of(name.begin(), name.end(), controls);
}

/// For the operator; teeth and passes count from 1.
std::string placeText(const Place& at, const GrindProgram& program) {
  std::ostringstream text;
  text << " (at " << toString(program.moves()[at.move_index].kind) << " of tooth " << at.tooth + 1 << ", pass "
       << at.pass + 1 << ", X = " << at.x << " m)";
  return text.str();
}

}  // namespace

GoalDesk::GoalDesk(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, Planner& planner,
                   Telemetry& telemetry, JournalWriter& journal)
    : loop_(loop),
      gate_(gate),
      planner_(planner),
      telemetry_(telemetry),
      tracker_(journal),
      thread_(kPollPeriod, [this] { poll(); }) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_.queue());
  server_ = std::make_unique<Server>(
      nh, "grind", [this](const GoalHandle& handle) { onGoal(handle); },
      [this](const GoalHandle& handle) { onCancel(handle); }, false);
  server_->start();
  thread_.start();
}

void GoalDesk::reject(GoalHandle& handle, int code, const std::string& text) {
  ROS_WARN_STREAM("goal rejected: " << text);
  handle.setRejected(result(code, text), text);
}

void GoalDesk::onGoal(GoalHandle handle) {
  if (goal_) {
    return reject(handle, GrindResult::BUSY, "a goal is running; allowed: wait for its end, or cancel it");
  }
  const auto goal = handle.getGoal();
  if (!isName(goal->job_name)) {
    return reject(handle, GrindResult::INVALID_GOAL,
                  "job_name has " + std::to_string(goal->job_name.size()) + " characters; allowed: up to " +
                      std::to_string(kLongestName) + ", and none that controls a terminal");
  }
  const GrindJob job = jobFromGoal(*goal);
  const std::string digest = jobDigest(job);
  if (!goal->dry_run) {
    const std::string text = refusal(*goal, digest);
    if (!text.empty()) return reject(handle, GrindResult::NOT_READY, text);
  }
  startPlanning(handle, job, digest);
}

std::string GoalDesk::refusal(const GrindGoal& goal, const std::string& digest) const {
  if (ros::SteadyTime::now() - last_cycle_ > kLoopTimeout) return "the control loop does not answer";
  const LoopStatus status = loop_.status();
  if (status.state != MachineState::kReady) {
    return std::string("the machine is in state ") + toString(status.state) + "; allowed: " + allowedIn(status.state);
  }
  if (status.wheel.in_work) return "the wheel stands in the work of the last job; lift it first";
  return goal.discard ? "" : tracker_.refusal(digest, {goal.first_tooth, goal.first_pass});
}

void GoalDesk::startPlanning(const GoalHandle& handle, const GrindJob& job, const std::string& digest) {
  GoalHandle goal = handle;
  const auto control = std::make_shared<PlanControl>();
  if (!gate_.open(handle.getGoalID(), [control] { control->give_up = true; })) {
    return reject(goal, GrindResult::NOT_READY, "the grinder is being shut down");
  }
  Planner::Request request;
  request.job = job;
  request.start = Eigen::Map<const Axes>(loop_.status().command.data());
  request.first = {handle.getGoal()->first_tooth, handle.getGoal()->first_pass};
  request.control = control;
  request.done = [this](std::unique_ptr<Preview> preview) {
    thread_.post([this, preview = std::shared_ptr<Preview>(std::move(preview))] { onPlanned(preview); });
  };
  if (!planner_.submit(std::move(request))) {
    gate_.close();
    return reject(goal, GrindResult::BUSY, "another job is being planned; allowed: wait for the end of that");
  }
  goal_ = Goal{handle, digest, control};
  busy_ = true;
  publishPlanningFeedback();
}

void GoalDesk::onCancel(const GoalHandle& handle) {
  // Repeats what StopDesk did: by now everything queued here before the cancel has been processed.
  if (gate_.cancel(handle.getGoalID())) loop_.postStop(MachineEvent::kCancel);
}

void GoalDesk::onPlanned(std::shared_ptr<Preview> preview) {
  GoalHandle handle = goal_->handle;
  const JobPlan& plan = preview->plan;
  const bool recalled = handle.getGoalStatus().status == actionlib_msgs::GoalStatus::RECALLING;
  if (recalled || gate_.canceled()) return cancelBeforeStart();
  if (!plan.good()) {
    release();
    return reject(handle, errorCode(plan.fault), join(plan.reasons));
  }
  handle.setAccepted();
  if (handle.getGoal()->dry_run) {
    release();
    telemetry_.show(preview);
    return handle.setSucceeded(result(GrindResult::SUCCESSFUL, "planned and checked; nothing moved", plan.statistics));
  }
  goal_->phase = Phase::kJournaling;
  goal_->preview = std::move(preview);
  goal_->number = loop_.status().jobs_started + 1;
  tracker_.begin(*plan.program, goal_->digest, handle.getGoal()->job_name, goal_->preview->first, goal_->number);
}

void GoalDesk::poll() {
  const LoopStatus status = loop_.status();
  if (status.cycles != cycles_) last_cycle_ = ros::SteadyTime::now();
  cycles_ = status.cycles;
  tracker_.update(status);
  if (!goal_) return;
  switch (goal_->phase) {
    case Phase::kPlanning: return publishPlanningFeedback();
    case Phase::kJournaling: return startWhenJournaled();
    case Phase::kStarting: return checkStartReply();
    case Phase::kRunning: return endWhenPublished();
  }
}

void GoalDesk::publishPlanningFeedback() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (now - goal_->last_feedback < kPlanningInterval) return;
  goal_->last_feedback = now;
  GrindFeedback feedback;
  feedback.state = "planning";
  feedback.planned = goal_->control->done;
  goal_->handle.publishFeedback(feedback);
}

void GoalDesk::startWhenJournaled() {
  if (gate_.canceled()) return cancelBeforeStart();
  if (!tracker_.upToDate()) return;
  const std::string error = tracker_.error();
  if (!error.empty()) return abortGoal(error);
  telemetry_.announceJob(goal_->number, goal_->handle.getGoalID(), goal_->preview);
  SetpointStream* stream = goal_->preview->stream.get();
  bool posted = false;
  const bool started = gate_.start([&](bool held) {
    posted = loop_.postStart(stream);
    if (posted && held) loop_.postStop(MachineEvent::kHold);
  });
  goal_->phase = Phase::kStarting;
  if (!started) return cancelBeforeStart();
  if (!posted) abortGoal("the control loop has not answered the start of the job before");
}

void GoalDesk::checkStartReply() {
  const auto reply = loop_.startReply();
  if (!reply) return;
  if (!reply->accepted) return abortGoal(reply->text);
  goal_->phase = Phase::kRunning;
}

void GoalDesk::cancelBeforeStart() {
  GoalHandle handle = goal_->handle;
  rollBack();
  const char* text = "canceled before it moved";
  handle.setCanceled(result(GrindResult::CANCELED, text), text);
}

void GoalDesk::abortGoal(const std::string& text) {
  GoalHandle handle = goal_->handle;
  rollBack();
  ROS_WARN_STREAM("goal aborted: " << text);
  handle.setAborted(result(GrindResult::NOT_READY, text), text);
}

void GoalDesk::rollBack() {
  if (goal_->phase == Phase::kStarting) telemetry_.withdrawJob(goal_->number);
  if (goal_->phase != Phase::kPlanning) tracker_.revert();
  release();
}

void GoalDesk::endWhenPublished() {
  const LoopStatus status = loop_.status();
  if (status.jobs_ended < goal_->number) return;
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (goal_->ended.isZero()) {
    goal_->ended = now;
    tracker_.end(status);
  }
  const bool reported = telemetry_.jobsPublished() >= goal_->number && tracker_.upToDate();
  if (reported || now - goal_->ended > kEndTimeout) endJob();
}

void GoalDesk::endJob() {
  const LoopStatus status = loop_.status();
  GoalHandle handle = goal_->handle;
  const std::shared_ptr<const Preview> preview = goal_->preview;
  release();
  Place at = status.place;
  if (status.setpoints_written == 0) {  // no setpoint reached the axes
    at.tooth = static_cast<std::uint16_t>(preview->first.tooth);
    at.pass = static_cast<std::uint16_t>(preview->first.pass);
    at.x = preview->plan.program->start()[kX];
  }
  const std::string place = placeText(at, *preview->plan.program);
  GrindResult r = result(GrindResult::SUCCESSFUL, "", preview->plan.statistics);
  r.setpoints_written = status.setpoints_written;
  switch (status.end) {
    case JobEnd::kFault:
      r.error_code = errorCode(status.fault.kind);
      r.error_string = status.fault.text() + place;
      ROS_ERROR_STREAM("goal aborted: " << r.error_string);
      return handle.setAborted(r, r.error_string);
    case JobEnd::kCanceled:
      r.error_code = GrindResult::CANCELED;
      r.error_string = "canceled; stopped on the path" + place;
      return handle.setCanceled(r, r.error_string);
    case JobEnd::kNone:
    case JobEnd::kDone: return handle.setSucceeded(r);
  }
}

void GoalDesk::release() {
  gate_.close();
  goal_.reset();
  busy_ = false;
}

}  // namespace flute_grinder
