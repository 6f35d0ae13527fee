#include "node/goal_server.h"

#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/messages/plan_result.h"
#include "flute_grinder/messages/reasons.h"
#include "node/plain_name.h"

#include <chrono>
#include <utility>

namespace grinder {

namespace {

constexpr double kPollPeriod = 0.001;             ///< period with a goal [s]
constexpr double kIdlePollPeriod = 0.02;          ///< period without a goal [s]
constexpr double kStartPollPeriod = 0.0001;       ///< period while a job starts and waits for its entry [s]
const ros::WallDuration kPlanningInterval(0.05);  ///< time between feedback messages while planning
/// How long the result waits for the last setpoints to be published and the journal to be written.
const ros::WallDuration kEndTimeout(0.5);

flute_grinder::GrindResult result(int code, const std::string& text) {
  flute_grinder::GrindResult r;
  r.error_code = code;
  r.error_string = text;
  return r;
}

flute_grinder::GrindResult result(int code, const std::vector<Reason>& reasons) {
  flute_grinder::GrindResult r = result(code, text(reasons));
  r.reasons = toMessage(reasons);
  return r;
}

/// The outcome of a job as written in its record.
const char* outcomeOf(JobEnd end) {
  switch (end) {
    case JobEnd::kFault: return "fault";
    case JobEnd::kCanceled: return "canceled";
    case JobEnd::kNone:
    case JobEnd::kDone: break;
  }
  return "done";
}

ToothPass firstOf(const flute_grinder::GrindGoal& goal) { return {goal.first_tooth, goal.first_pass}; }

/// Why and where a job ended. A refused setpoint brings its own place.
Reason endReason(const LoopStatus& status, const Place& at, const GrindProgram& program) {
  Reason reason;
  reason.kind = ReasonKind::kCanceled;
  if (status.end == JobEnd::kFault) reason = reasonOf(status.fault);
  if (reason.has_place) return reason;
  reason.has_place = true;
  reason.move = program.moves()[at.move_index].kind;
  reason.tooth = at.tooth;
  reason.pass = at.pass;
  reason.x = at.x;
  return reason;
}

}  // namespace

GoalServer::GoalServer(const ros::NodeHandle& private_nh, ControlLoop& loop, JobGate& gate, StopServer& stops,
                       Planner& planner, Telemetry& telemetry, Journal& journal, OffsetServer& offsets,
                       const LoopWatchdog& watchdog)
    : loop_(loop),
      gate_(gate),
      planner_(planner),
      telemetry_(telemetry),
      offsets_(offsets),
      watchdog_(watchdog),
      tracker_(journal),
      thread_(std::make_shared<ServedQueue>(kIdlePollPeriod, [this] { poll(); })) {
  offsets_.noteFinished(tracker_.progress());
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(thread_->queue());
  job_ = nh.advertise<flute_grinder::GrindActionGoal>("job", 1, true);
  server_ = std::make_unique<Server>(
      nh, "grind", [this](const GoalHandle& handle) { onGoal(handle); },
      [this](const GoalHandle& handle) { onCancel(handle); },
      [](flute_grinder::GrindResult& recalled, const std::string& why) {
        if (recalled.error_string.empty()) recalled = result(flute_grinder::GrindResult::CANCELED, why);
      });
  server_->start();
  cancels_ = stops.subscribeToCancels(
      [this, thread = std::weak_ptr<ServedQueue>(thread_)](const actionlib_msgs::GoalID::Ptr& what) {
        if (const auto running = thread.lock()) running->post([this, what] { server_->cancel(what); });
      });
  thread_->start();
}

GoalServer::~GoalServer() {
  cancels_.shutdown();
  thread_->stop();
}

void GoalServer::reject(GoalHandle& handle, int code, const std::string& text) { reject(handle, result(code, text)); }

void GoalServer::reject(GoalHandle& handle, const flute_grinder::GrindResult& result) {
  ROS_WARN_STREAM("goal rejected: " << result.error_string);
  handle.setRejected(result, result.error_string);
}

void GoalServer::onGoal(GoalHandle handle) {
  if (goal_) {
    const char* beside = handle.getGoal()->dry_run ? "; 'grind plan' plans without the grinder" : "";
    return reject(handle, flute_grinder::GrindResult::BUSY,
                  std::string("a goal is running; allowed: wait for its end, or cancel it") + beside);
  }
  const auto goal = handle.getGoal();
  for (const auto& [key, name] :
       {std::pair("job_name", &goal->job_name), std::pair("wheel_name", &goal->wheel_name),
        std::pair("wheel_dressed", &goal->wheel_dressed), std::pair("sent_by", &goal->sent_by)}) {
    if (!isPlainName(*name)) {
      return reject(handle, flute_grinder::GrindResult::INVALID_GOAL, nameRefusal(key, *name));
    }
  }
  const std::string wrong = answersRefusal(goal->answers);
  if (!wrong.empty()) return reject(handle, flute_grinder::GrindResult::INVALID_GOAL, wrong);
  try {
    const ValidJob job(jobFromGoal(*goal));
    const std::string text = goal->dry_run ? "" : refusal(*goal, job.digest());
    if (!text.empty()) return reject(handle, flute_grinder::GrindResult::NOT_READY, text);
    begin(handle, job);
  } catch (const InvalidJob& invalid) {
    reject(handle, result(errorCode(PlanFault::kInvalidJob), invalid.reasons()));
  }
}

std::string GoalServer::refusal(const flute_grinder::GrindGoal& goal, const std::string& digest) const {
  if (watchdog_.loopHangs()) return "the control loop does not answer";
  const LoopStatus status = loop_.status();
  if (status.state != MachineState::kReady) {
    return std::string("the machine is in state ") + toString(status.state) + "; allowed: " + allowedIn(status.state);
  }
  if (!status.wheel.known) return "it is not known whether the wheel is in the work; lift it first";
  if (status.wheel.in_work) return "the wheel is in the work of the last job; lift it first";
  return tracker_.refusal(digest, firstOf(goal));
}

/// What a start of the goal's job needs, answered or not.
std::vector<Need> GoalServer::needsOf(const Goal& goal, const WorkOffsets& offsets) const {
  const flute_grinder::GrindGoal& asked = *goal.handle.getGoal();
  const std::string& digest = goal.job.digest();
  std::vector<Need> needs;
  const auto add = [&](std::optional<Need> need) {
    if (need) needs.push_back(std::move(*need));
  };
  add(tracker_.need(digest, firstOf(asked)));
  add(tracker_.offsetNeed(digest, firstOf(asked), offsets));
  // A job that is continued needs only the offsets with which it began; after the flutes, the teeth must also be
  // where they were.
  const bool placed = asked.operation == 0 || offsets.tool.unknown != TeethUnknown::kHomed;
  if (!(placed && needs.empty() && tracker_.continues(digest, offsets))) {
    for (Need& need : grinder::needsOf(mismatches(offsets, asked))) needs.push_back(std::move(need));
  }
  // The loop checks the swivel once more when the job starts: it may be turned meanwhile.
  add(needOf(loop_.status().swivel, goal.job->process().setup_swivel));
  return needs;
}

void GoalServer::begin(const GoalHandle& handle, const ValidJob& job) {
  GoalHandle goal = handle;
  const auto control = std::make_shared<PlanControl>();
  if (!gate_.open(handle.getGoalID(), [control] { control->give_up = true; })) {
    return reject(goal, flute_grinder::GrindResult::NOT_READY,
                  gate_.isShut()
                      ? "the grinder is being shut down"
                      : "a work offset is being set, or the machine probes; allowed: wait for the end of that");
  }
  // From here to the end of the goal nobody else changes the offsets.
  goal_ = Goal{handle, job, control};
  busy_ = true;
  thread_->setPeriod(kPollPeriod);
  carryOutAnswers();
}

/// Carries out those answers on which the plan depends, one after the other; then plans.
void GoalServer::carryOutAnswers() {
  const flute_grinder::GrindGoal& asked = *goal_->handle.getGoal();
  const WorkOffsets offsets = offsets_.offsets();
  const std::string unknown = offsets_.unknown();
  if (!unknown.empty()) return refuse(result(flute_grinder::GrindResult::NOT_READY, unknown));
  const std::vector<Need> needs = needsOf(*goal_, offsets);
  for (const Need& need : needs) {
    if (need.kind == NeedKind::kSwivel) goal_->swivel_confirmed = isAnswered(need, asked.answers);
    for (const NeedAnswer answer : need.answers) {
      if (!rowOf(answer).changes_plan || !isAnswered(need, answer, asked.answers)) continue;
      goal_->answered = offsets_.carryOut(answer, basisOf(asked, OffsetMethod::kUnknown), asked.sent_by);
      return;
    }
  }
  goal_->needs = unanswered(needs, asked.answers);
  if (!asked.dry_run && !goal_->needs.empty()) return refuse(resultOf(goal_->needs));
  plan(offsets);
}

/// Once an answer has been carried out, looks for the next.
void GoalServer::takeAnswered() {
  if (goal_->answered.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  const std::string refused = goal_->answered.get();
  if (gate_.canceled()) return cancelBeforeStart();
  if (!refused.empty()) return refuse(result(flute_grinder::GrindResult::NOT_READY, refused));
  carryOutAnswers();
}

void GoalServer::plan(const WorkOffsets& offsets) {
  const flute_grinder::GrindGoal& asked = *goal_->handle.getGoal();
  goal_->phase = Phase::kPlanning;
  goal_->offsets = offsets;
  Planner::Request request{goal_->job};
  request.run = {Eigen::Map<const Axes>(loop_.status().command.data()), firstOf(asked), offsets.values()};
  request.control = goal_->control;
  request.measures_passes = asked.dry_run != 0;
  request.done = [this](std::shared_ptr<const PlannedJob> planned) {
    thread_->post([this, planned = std::move(planned)] { onPlanned(planned); });
  };
  if (!planner_.submit(std::move(request))) {
    return refuse(result(flute_grinder::GrindResult::NOT_READY, "the grinder is being shut down"));
  }
  publishPlanningFeedback();
}

/// The result of a goal that does not answer its needs.
flute_grinder::GrindResult GoalServer::resultOf(const std::vector<Need>& needs) const {
  flute_grinder::GrindResult r = result(flute_grinder::GrindResult::NOT_READY, text(needs));
  r.plan.needs = toMessage(needs);
  for (const Need& need : needs) {
    if (need.kind != NeedKind::kSwivel) continue;
    r.reasons = {toMessage(reasonOf(loop_.status().swivel, goal_->job->process().setup_swivel))};
  }
  return r;
}

/// Ends the goal before it is planned.
void GoalServer::refuse(const flute_grinder::GrindResult& result) {
  GoalHandle handle = goal_->handle;
  release();
  reject(handle, result);
}

void GoalServer::onCancel(const GoalHandle& handle) {
  // Repeats what StopServer did: by now everything queued here before the cancel has been processed.
  if (gate_.cancel(handle.getGoalID())) loop_.postStop(MachineEvent::kCancel);
}

void GoalServer::onPlanned(std::shared_ptr<const PlannedJob> planned) {
  GoalHandle handle = goal_->handle;
  const bool recalled = handle.getGoalStatus().status == actionlib_msgs::GoalStatus::RECALLING;
  if (recalled || gate_.canceled()) return cancelBeforeStart();
  if (handle.getGoal()->dry_run || !planned->good()) {
    flute_grinder::GrindResult checked = resultOfPlan(*planned);
    release();
    if (!planned->good()) return reject(handle, checked);
    checked.error_string = "planned and checked; nothing moved";
    handle.setAccepted();
    telemetry_.show(planned, handle.getGoal()->job_name);
    return handle.setSucceeded(checked);
  }
  goal_->plan = std::move(planned);
  startJob();
}

void GoalServer::startJob() {
  GoalHandle handle = goal_->handle;
  const flute_grinder::GrindGoal& asked = *handle.getGoal();
  goal_->phase = Phase::kStarting;
  thread_->setPeriod(kStartPollPeriod);
  goal_->number = loop_.status().jobs_started + 1;
  // Spindle and coolant start while the disk writes; the axes wait for the entry.
  const PlannedJob& plan = *goal_->plan;
  goal_->stream = std::make_unique<SetpointStream>(plan.program);
  tracker_.begin(*plan.program, plan.program->job().digest(), basisOf(asked, OffsetMethod::kUnknown), goal_->number,
                 goal_->offsets);
  telemetry_.announceJob(
      goal_->number, handle.getGoalID().id, asked.job_name, goal_->plan,
      std::make_shared<JobRecord>(plan, JobNames{asked.job_name, asked.wheel_name, asked.wheel_dressed}, goal_->offsets,
                                  gives(asked.answers, NeedAnswer::kIgnoreOffsets)));
  const JobStart start{goal_->stream.get(), wheelOf(*plan.program), false, goal_->swivel_confirmed};
  bool posted = false;
  const bool started = gate_.start([&](bool held) {
    posted = loop_.startJob(start);
    if (posted && held) loop_.postStop(MachineEvent::kHold);
  });
  if (!started) return cancelBeforeStart();
  if (!posted) {
    rollBack();
    return reject(handle, flute_grinder::GrindResult::NOT_READY,
                  "the control loop has not answered the start of the job before");
  }
  handle.setAccepted();
  publishJob();
}

void GoalServer::poll() {
  const LoopStatus status = loop_.status();
  tracker_.update(status);
  if (!goal_) return;
  publishFeedback();
  switch (goal_->phase) {
    case Phase::kAnswering: return takeAnswered();
    case Phase::kPlanning: return;
    case Phase::kStarting: return checkStartReply();
    case Phase::kJournaling: return releaseWhenJournaled();
    case Phase::kRunning: return endWhenPublished();
  }
}

void GoalServer::publishFeedback() {
  if (goal_->phase <= Phase::kPlanning) return publishPlanningFeedback();
  if (const auto feedback = telemetry_.takeFeedback(goal_->number)) goal_->handle.publishFeedback(*feedback);
}

void GoalServer::publishPlanningFeedback() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (now - goal_->last_feedback < kPlanningInterval) return;
  goal_->last_feedback = now;
  flute_grinder::GrindFeedback feedback;
  feedback.state = "planning";
  feedback.planned = goal_->control->done;
  goal_->handle.publishFeedback(feedback);
}

void GoalServer::publishJob() {
  flute_grinder::GrindActionGoal job;
  job.header.stamp = ros::Time::now();
  job.goal_id = goal_->handle.getGoalID();
  job.goal = *goal_->handle.getGoal();
  job_.publish(job);
}

void GoalServer::checkStartReply() {
  const auto reply = loop_.startJobReply();
  if (!reply) return;
  if (!reply->accepted) return abortGoal(reply->text);
  goal_->phase = Phase::kJournaling;
}

void GoalServer::releaseWhenJournaled() {
  const bool ended = loop_.status().jobs_ended >= goal_->number;
  if (!ended && !tracker_.upToDate()) return;
  goal_->phase = Phase::kRunning;
  thread_->setPeriod(kPollPeriod);
  if (ended) return;
  goal_->journal_error = tracker_.error();
  if (goal_->journal_error.empty()) {
    loop_.confirmJournal(goal_->number);
    const flute_grinder::GrindGoal& asked = *goal_->handle.getGoal();
    offsets_.noteGrinding(basisOf(asked, OffsetMethod::kUnknown), asked.first_tooth == 0 && asked.first_pass == 0);
  } else {
    loop_.postStop(MachineEvent::kCancel);
  }
}

void GoalServer::cancelBeforeStart() {
  GoalHandle handle = goal_->handle;
  rollBack();
  const char* text = "canceled before it moved";
  handle.setCanceled(result(flute_grinder::GrindResult::CANCELED, text), text);
}

void GoalServer::abortGoal(const std::string& text) {
  GoalHandle handle = goal_->handle;
  rollBack();
  ROS_WARN_STREAM("goal aborted: " << text);
  handle.setAborted(result(flute_grinder::GrindResult::NOT_READY, text), text);
}

void GoalServer::rollBack() {
  if (goal_->phase > Phase::kPlanning) {
    telemetry_.withdrawJob(goal_->number);
    tracker_.revert();
  }
  release();
}

void GoalServer::endWhenPublished() {
  const LoopStatus status = loop_.status();
  if (status.jobs_ended < goal_->number) return;
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (goal_->ended.isZero()) {
    goal_->ended = now;
    if (goal_->journal_error.empty()) {
      const std::string how = resultOfJob(status).error_string;
      tracker_.end(status, how.empty() ? outcomeOf(status.end) : how);
      offsets_.noteFinished(tracker_.progress());
    } else {
      tracker_.revert();
    }
  }
  const bool reported = telemetry_.jobsPublished() >= goal_->number && tracker_.upToDate();
  if (reported || now - goal_->ended > kEndTimeout) endJob();
}

void GoalServer::endJob() {
  const LoopStatus status = loop_.status();
  GoalHandle handle = goal_->handle;
  const std::uint64_t number = goal_->number;
  const bool aborted = status.end == JobEnd::kFault || !goal_->journal_error.empty();
  const flute_grinder::GrindResult r = resultOfJob(status);
  publishFeedback();
  release();
  telemetry_.concludeJob(number, {outcomeOf(status.end), r.error_string, r.setpoints_written});
  if (aborted) {
    ROS_ERROR_STREAM("goal aborted: " << r.error_string);
    return handle.setAborted(r, r.error_string);
  }
  if (status.end == JobEnd::kCanceled) return handle.setCanceled(r, r.error_string);
  handle.setSucceeded(r);
}

flute_grinder::GrindResult GoalServer::resultOfPlan(const PlannedJob& plan) const {
  flute_grinder::GrindResult r = grinder::resultOf(plan);
  r.plan.offsets = toMessage(goal_->offsets);
  r.plan.offsets.header.stamp = ros::Time::now();
  r.plan.needs = toMessage(goal_->needs);
  // A kept plan has them or not, by what was asked before.
  if (!goal_->handle.getGoal()->dry_run) r.plan.passes.clear();
  return r;
}

flute_grinder::GrindResult GoalServer::resultOfJob(const LoopStatus& status) const {
  const PlannedJob& plan = *goal_->plan;
  Place at = status.place;
  if (status.setpoints_written == 0) {  // no setpoint reached the axes
    at.tooth = static_cast<std::uint16_t>(plan.program->run().first.tooth);
    at.pass = static_cast<std::uint16_t>(plan.program->run().first.pass);
    at.x = plan.program->start()[kX];
  }
  flute_grinder::GrindResult r = result(flute_grinder::GrindResult::SUCCESSFUL, "");
  if (!goal_->journal_error.empty()) {
    r = result(flute_grinder::GrindResult::NOT_READY, goal_->journal_error);
  } else if (status.end == JobEnd::kFault) {
    r = result(errorCode(status.fault.kind), {endReason(status, at, *plan.program)});
  } else if (status.end == JobEnd::kCanceled) {
    r = result(flute_grinder::GrindResult::CANCELED, {endReason(status, at, *plan.program)});
  }
  r.plan = resultOfPlan(plan).plan;
  r.setpoints_written = status.setpoints_written;
  return r;
}

void GoalServer::release() {
  gate_.close();
  goal_.reset();
  busy_ = false;
  thread_->setPeriod(kIdlePollPeriod);
}

}  // namespace grinder
