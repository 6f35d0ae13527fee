#include "flute_grinder/node/grinder_node.h"

#include "flute_grinder/GrinderState.h"
#include "flute_grinder/node/conversions.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

namespace flute_grinder {

namespace {

constexpr double kTickPeriod = 0.01;             ///< of joint states [s]
constexpr std::uint64_t kTicksPerBatch = 5;      ///< setpoints, state and feedback
constexpr std::uint64_t kTicksPerScene = 10;     ///< what rviz shows of a job
constexpr std::uint64_t kTicksPerJournal = 100;  ///< within a pass

int errorCode(PlanFault fault) {
  switch (fault) {
    case PlanFault::kNone: return GrindResult::SUCCESSFUL;
    case PlanFault::kInvalidJob: return GrindResult::INVALID_GOAL;
    case PlanFault::kLimit: return GrindResult::LIMIT_VIOLATED;
    case PlanFault::kTolerance: return GrindResult::PATH_TOLERANCE_VIOLATED;
    case PlanFault::kTooLong: return GrindResult::INVALID_GOAL;
    case PlanFault::kGivenUp: return GrindResult::CANCELED;
  }
  return GrindResult::INVALID_GOAL;
}

int errorCode(FaultKind fault) {
  switch (fault) {
    case FaultKind::kNone: return GrindResult::SUCCESSFUL;
    case FaultKind::kEmergencyStop: return GrindResult::EMERGENCY_STOP;
    case FaultKind::kStaleFeedback: return GrindResult::LINK_LOST;
    case FaultKind::kFollowingError: return GrindResult::PATH_TOLERANCE_VIOLATED;
    case FaultKind::kLimit: return GrindResult::LIMIT_VIOLATED;
    case FaultKind::kDriveFault:
    case FaultKind::kPowerLost:
    case FaultKind::kUnderrun:
    case FaultKind::kLate:
    case FaultKind::kHoming:
    case FaultKind::kInvalidFeedback: return GrindResult::HARDWARE_FAULT;
    case FaultKind::kInterlock: return GrindResult::NOT_READY;
  }
  return GrindResult::HARDWARE_FAULT;
}

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

/// For people, who count teeth and passes from 1.
std::string place(const Setpoint& p) {
  std::ostringstream text;
  text << " (at " << toString(p.move) << " of tooth " << p.tooth + 1 << ", pass " << p.pass + 1
       << ", X = " << p.position[kX] << " m)";
  return text.str();
}

/// The journal's file, or, of a folder, the one in it that is named after the node.
std::string journalPath(const std::string& parameter, const std::string& node) {
  return parameter.back() == '/' ? parameter + node.substr(1) + ".journal" : parameter;
}

double fraction(double done, double all) { return all == 0 ? 0 : std::clamp(done / all, 0.0, 1.0); }

}  // namespace

GrinderNode::GrinderNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh), private_nh_(private_nh) {
  std::string urdf;
  if (!nh_.getParam("robot_description", urdf)) {
    throw MachineConfigError("parameter " + nh_.resolveName("robot_description") + " is missing; allowed: a URDF");
  }
  XmlRpc::XmlRpcValue values;
  private_nh_.getParam("", values);
  const ParameterReader parameters(values, private_nh_.getNamespace());
  const LoopConfig config = readMachineConfig(urdf, parameters);
  diagnostics_ = std::make_unique<Diagnostics>(config, readDiagnosticThresholds(parameters), [this] {
    return Scheduling{loop_->realtimeScheduling(), loop_->memoryLocked()};
  });
  journal_ = std::make_unique<Journal>(journalPath(parameters.text("journal"), private_nh_.getNamespace()));
  readJournal();
  loadDrive(parameters);
  loop_ = std::make_unique<ControlLoop>(*hw_, config);
  batch_.period = config.machine.period;
  advertise();
  loop_->startThread();
  server_->start();
}

void GrinderNode::readJournal() {
  try {
    progress_ = journal_->read().value_or(Progress{});
  } catch (const JournalError& error) {
    diagnostics_->setJournalError(error.what());
    ROS_ERROR_STREAM(error.what() << "; the last job cannot be continued");
  }
}

void GrinderNode::loadDrive(const ParameterReader& parameters) {
  const std::string type = parameters.text("hardware/type");
  loader_ = std::make_unique<pluginlib::ClassLoader<RobotHW>>("flute_grinder", "flute_grinder::RobotHW");
  if (!loader_->isClassAvailable(type)) {
    throw MachineConfigError("parameter " + parameters.name("hardware/type") + " = " + type +
                             "; allowed: " + join(loader_->getDeclaredClasses()));
  }
  try {
    hw_ = loader_->createUniqueInstance(type);
  } catch (const pluginlib::PluginlibException& error) {
    throw MachineConfigError("parameter " + parameters.name("hardware/type") + " = " + type + " cannot be loaded: " +
                             error.what() + " What it is: " + loader_->getClassDescription(type));
  }
  ros::NodeHandle hardware_nh(private_nh_, "hardware");
  if (!hw_->init(private_nh_, hardware_nh)) throw MachineConfigError("the drive " + type + " could not be initialised");
}

void GrinderNode::advertise() {
  joint_states_ = nh_.advertise<sensor_msgs::JointState>("joint_states", 10);
  state_ = private_nh_.advertise<GrinderState>("state", 10, true);
  setpoints_ = private_nh_.advertise<SetpointBatch>("setpoints", 1000);
  scene_ = std::make_unique<Scene>(private_nh_);

  diagnostic_updater_ = std::make_unique<diagnostic_updater::Updater>(nh_, private_nh_);
  diagnostic_updater_->setHardwareID(private_nh_.param<std::string>("hardware/type", ""));
  diagnostics_->addTo(*diagnostic_updater_);

  const auto trigger = [this](const char* name, MachineEvent event) {
    const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> callback =
        [this, event](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
          return onRequest(event, response);
        };
    services_.push_back(private_nh_.advertiseService(name, callback));
  };
  trigger("enable", MachineEvent::kEnable);
  trigger("disable", MachineEvent::kDisable);
  trigger("home", MachineEvent::kHome);
  trigger("hold", MachineEvent::kHold);
  trigger("resume", MachineEvent::kResume);
  trigger("retract", MachineEvent::kRetract);
  trigger("reset_fault", MachineEvent::kReset);
  services_.push_back(private_nh_.advertiseService("set_feed_override", &GrinderNode::onFeedOverride, this));
  services_.push_back(private_nh_.advertiseService("plan", &GrinderNode::onPlan, this));

  server_ = std::make_unique<Server>(
      private_nh_, "grind", [this](const GoalHandle& goal) { onGoal(goal); },
      [this](const GoalHandle& goal) { onCancel(goal); }, false);
  timer_ = nh_.createSteadyTimer(ros::WallDuration(kTickPeriod), [this](const ros::SteadyTimerEvent&) { tick(); });
}

void GrinderNode::shutDown() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (job_) cancelJob();
  }
  // The spinners may be gone already, so that this thread sees the job to its end.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  for (bool moving = true; moving && std::chrono::steady_clock::now() < deadline;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const std::lock_guard<std::mutex> lock(mutex_);
    takeRecords();
    moving = job_ != nullptr;
  }
  ask(MachineEvent::kDisable);
  loop_->stopThread();
}

void GrinderNode::reject(GoalHandle& goal, int code, const std::string& text) {
  ROS_WARN_STREAM("goal rejected: " << text);
  goal.setRejected(result(code, text), text);
}

void GrinderNode::onGoal(GoalHandle goal) {
  MachineState state;
  Axes start;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (job_ || planning_) {
      return reject(goal, GrindResult::BUSY, "a goal is running; allowed: wait for its end, or cancel it");
    }
    if (!refresh()) return reject(goal, GrindResult::NOT_READY, "the control loop does not answer");
    state = record_.state;
    start = record_.command;
    planning_ = goal;
    planning_canceled_ = false;
  }
  const auto request = goal.getGoal();
  const bool wanted = state == MachineState::kReady || request->dry_run;
  Preview preview;
  if (wanted) preview = makePreview(*request, start);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    planning_.reset();
    if (planning_canceled_) {
      const char* text = "canceled before it moved";
      return goal.setCanceled(result(GrindResult::CANCELED, text), text);
    }
    if (!wanted) {
      return reject(goal, GrindResult::NOT_READY,
                    std::string("the machine is in state ") + toString(state) + "; allowed: " + allowedIn(state));
    }
    if (!preview.plan.good()) return reject(goal, errorCode(preview.plan.fault), join(preview.plan.reasons));
    goal.setAccepted();
    show(preview);
    if (!request->dry_run) startJob(goal, preview.plan);
  }
  if (request->dry_run) {
    goal.setSucceeded(result(GrindResult::SUCCESSFUL, "planned and checked; nothing moved", preview.plan.statistics));
  }
}

GrinderNode::Preview GrinderNode::makePreview(const GrindGoal& goal, const Axes& start) const {
  const GrindJob job = jobFromGoal(goal);
  Preview preview;
  if (validate(job).empty()) preview.errors.emplace(ConicalCutter(job.cutter));
  preview.first = {goal.first_tooth, goal.first_pass};
  // Every stroke of a job has the same errors.
  preview.plan = planJob(job, loop_->config().machine, start, preview.first, [&](const Setpoint& p) {
    if (p.tooth == preview.first.tooth && p.pass == preview.first.pass) preview.errors->add(p);
  });
  return preview;
}

void GrinderNode::show(const Preview& preview) { scene_->show(*preview.plan.program, preview.first, *preview.errors); }

void GrinderNode::startJob(GoalHandle& goal, JobPlan& plan) {
  const GrindJob& job = plan.program->job();
  const auto request = goal.getGoal();
  const Progress before = progress_;
  progress_ = {jobDigest(job), false, {request->first_tooth, request->first_pass}, plan.program->strokeFrom()};
  std::string refusal = writeJournal();
  if (refusal.empty()) {
    Setpoint at_start;
    at_start.position = plan.program->start();
    at_start.tooth = request->first_tooth;
    at_start.pass = request->first_pass;
    job_ = std::make_unique<Job>(Job{goal, std::make_unique<SetpointStream>(*plan.program), plan.statistics,
                                     std::move(plan.move_ends), passOrder(job), at_start});
    const RequestReply reply = askToStart(job_->stream.get());
    if (reply.accepted) return;
    // A loop that has not answered may yet begin to use the stream.
    if (!reply.answered) static_cast<void>(job_->stream.release());
    job_.reset();
    refusal = reply.text;
  }
  progress_ = before;
  writeJournal();
  ROS_WARN_STREAM(refusal);
  goal.setAborted(result(GrindResult::NOT_READY, refusal), refusal);
}

void GrinderNode::onCancel(const GoalHandle& goal) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (planning_ && *planning_ == goal) planning_canceled_ = true;
  if (!job_ || job_->goal != goal) return;
  cancelJob();
}

void GrinderNode::cancelJob() {
  const RequestReply reply = ask(MachineEvent::kCancel);
  // A cancel that comes once more, after the stop, is refused.
  if (reply.accepted) job_->canceled = true;
  if (!reply.accepted) ROS_WARN_STREAM(reply.text);
}

RequestReply GrinderNode::ask(MachineEvent event) {
  const std::lock_guard<std::mutex> lock(request_mutex_);
  return isStop(event) ? loop_->stop(event) : loop_->request(event);
}

RequestReply GrinderNode::askToStart(SetpointStream* stream) {
  loop_->postStart(stream);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  while (std::chrono::steady_clock::now() < deadline) {
    if (const auto reply = loop_->startReply()) return *reply;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return {false, "the control loop does not answer", false};
}

bool GrinderNode::onRequest(MachineEvent event, std_srvs::Trigger::Response& response) {
  const RequestReply reply = ask(event);
  response.success = reply.accepted;
  response.message = reply.text;
  if (!reply.accepted) ROS_WARN_STREAM(reply.text);
  return true;
}

bool GrinderNode::onFeedOverride(SetFeedOverride::Request& request, SetFeedOverride::Response& response) {
  response.success = loop_->setFeedOverride(request.fraction);
  if (!response.success) {
    std::ostringstream text;
    text << "feed override = " << request.fraction << "; allowed: 0 to " << kMaxFeedOverride;
    response.message = text.str();
  }
  return true;
}

bool GrinderNode::onPlan(Plan::Request& request, Plan::Response& response) {
  Axes start;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!refresh()) {
      response.reasons.emplace_back("the control loop does not answer");
      return true;
    }
    start = record_.command;
  }
  const Preview preview = makePreview(request.goal, start);
  response.valid = preview.plan.good();
  response.statistics = toMessage(preview.plan.statistics);
  response.duration = preview.plan.statistics.duration;
  response.reasons = preview.plan.reasons;
  const std::lock_guard<std::mutex> lock(mutex_);
  // What is shown while a job runs is that job.
  if (preview.plan.good() && !job_) show(preview);
  return true;
}

void GrinderNode::tick() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    takeRecords();
    if (records_ == 0) return;
    publishJointStates();
    if (ticks_ % kTicksPerJournal == 0 && progress_made_) writeJournal();
    if (++ticks_ % kTicksPerBatch == 0) {
      publishBatch();
      publishState();
      publishFeedback();
    }
    if (ticks_ % kTicksPerScene == 0 && job_) scene_->update(toString(record_.state));
  }
  diagnostic_updater_->update();
}

void GrinderNode::takeRecords() {
  while (loop_->pop(record_)) {
    ++records_;
    follow(record_);
  }
}

bool GrinderNode::refresh() {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  takeRecords();
  // The first record to come may be of a cycle that had begun before.
  for (const std::uint64_t enough = records_ + 2; records_ < enough; takeRecords()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return true;
}

void GrinderNode::follow(const CycleRecord& record) {
  diagnostics_->watch(record);
  if (job_) followJob(record);
}

void GrinderNode::followJob(const CycleRecord& record) {
  if (record.has_setpoint) job_->waiting.push_back({job_->cycle, record.period, record.setpoint});
  // A drive may buffer commands: a setpoint is told with the positions of the cycle before the axes get it.
  auto& waiting = job_->waiting;
  while (!waiting.empty() && waiting.front().cycle + record.drive.commands_waiting <= job_->cycle) {
    job_->last = waiting.front().setpoint;
    trackProgress(job_->last);
    scene_->follow(job_->last, record.position);
    tell(waiting.front(), record);
    waiting.pop_front();
  }
  ++job_->cycle;
  if (!record.job_ended) return;
  // Written, but the axes never got them.
  for (const Waiting& never : waiting) tell(never, record);
  finishJob(record);
}

void GrinderNode::tell(const Waiting& written, const CycleRecord& record) {
  const Setpoint& setpoint = written.setpoint;
  if (batch_.setpoints.empty()) {
    batch_.header.stamp = ros::Time(record.time);
    batch_.goal_id = job_->goal.getGoalID().id;
  }
  ++job_->written;
  batch_.setpoints.push_back(toMessage(setpoint, record.position, written.period));
  batch_.end_stamp = ros::Time(record.time);
  job_->largest_error = std::max(job_->largest_error, std::abs(setpoint.path_error));
}

void GrinderNode::trackProgress(const Setpoint& p) {
  Progress& at = progress_;
  if (p.move != MoveKind::kStroke || at.finished || p.tooth != at.next.tooth || p.pass != at.next.pass) return;
  at.x = p.position[kX];
  progress_made_ = true;
  if (p.progress < 1) return;
  const auto is_this = [&](const ToothPass& pass) { return pass.tooth == p.tooth && pass.pass == p.pass; };
  const auto next = std::find_if(job_->passes.begin(), job_->passes.end(), is_this) + 1;
  at.finished = next == job_->passes.end();
  if (!at.finished) at.next = *next;
  // Before anybody is told that the pass is done, so that none is ground again that was seen to be finished.
  writeJournal();
}

std::string GrinderNode::writeJournal() {
  progress_made_ = false;
  std::string refusal;
  try {
    journal_->write(progress_);
  } catch (const JournalError& error) {
    refusal = error.what();
    ROS_ERROR_STREAM(refusal);
  }
  diagnostics_->setJournalError(refusal);
  return refusal;
}

GrindResult GrinderNode::resultOf(const Job& job, int code, const std::string& text) const {
  GrindResult r = result(code, text, job.statistics);
  r.setpoints_written = job.written;
  return r;
}

void GrinderNode::finishJob(const CycleRecord& record) {
  if (progress_made_) writeJournal();
  publishBatch();
  publishFeedback();
  scene_->end(toString(record.state));
  const std::unique_ptr<Job> job = std::move(job_);
  publishState();
  if (record.fault.kind != FaultKind::kNone) {
    const std::string text = record.fault.text() + place(job->last);
    ROS_ERROR_STREAM("goal aborted: " << text);
    job->goal.setAborted(resultOf(*job, errorCode(record.fault.kind), text), text);
  } else if (job->canceled) {
    const std::string text = "canceled; stopped on the path" + place(job->last);
    job->goal.setCanceled(resultOf(*job, GrindResult::CANCELED, text), text);
  } else {
    job->goal.setSucceeded(resultOf(*job, GrindResult::SUCCESSFUL, ""));
  }
}

void GrinderNode::publishJointStates() {
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(record_.time);
  for (int i = 0; i < kAxisCount; ++i) {
    message.name.emplace_back(kJointNames[static_cast<std::size_t>(i)]);
    message.position.push_back(record_.position[i]);
    message.velocity.push_back(record_.velocity[i]);
  }
  // Not of the drive, but robot_state_publisher takes all joints from here.
  message.name.insert(message.name.end(), {"wheel_swivel", "y_zero"});
  message.position.insert(message.position.end(), {scene_->setup().wheel_swivel, scene_->setup().y_zero});
  message.velocity.insert(message.velocity.end(), {0, 0});
  joint_states_.publish(message);
}

void GrinderNode::publishBatch() {
  if (batch_.setpoints.empty()) return;
  setpoints_.publish(batch_);
  batch_.setpoints.clear();
}

void GrinderNode::publishState() {
  GrinderState message;
  message.header.stamp = ros::Time(record_.time);
  message.state = static_cast<std::uint8_t>(record_.state);
  message.state_name = toString(record_.state);
  message.enabled = record_.drive.enabled;
  message.homed = record_.drive.homed;
  message.spindle_at_speed = record_.drive.spindle_at_speed;
  message.coolant_on = record_.drive.coolant_on;
  message.emergency_stop = record_.drive.emergency_stop;
  message.override = record_.feed_override;
  if (job_) {
    message.feed = job_->last.feed;
    message.tooth = job_->last.tooth;
    message.pass = job_->last.pass;
  }
  message.fault = record_.fault.text();
  message.hold_reason = toString(record_.interlock);
  message.progress.job_digest = progress_.job_digest;
  message.progress.finished = progress_.finished;
  message.progress.tooth = static_cast<std::uint16_t>(progress_.next.tooth);
  message.progress.pass = static_cast<std::uint16_t>(progress_.next.pass);
  message.progress.x = progress_.x;
  state_.publish(message);
}

double GrinderNode::plannedCycles() const {
  const Setpoint& p = job_->last;
  const auto& ends = job_->move_ends;
  const auto begin = static_cast<double>(p.move_index == 0 ? 0 : ends[p.move_index - 1]);
  return begin + p.progress * (static_cast<double>(ends[p.move_index]) - begin);
}

void GrinderNode::publishFeedback() {
  if (!job_) return;
  const Setpoint& p = job_->last;
  const GrindProgram& program = job_->stream->program();
  const double done = plannedCycles();
  const auto all = static_cast<double>(job_->move_ends.back());
  GrindFeedback feedback;
  feedback.state = toString(record_.state);
  feedback.tooth = p.tooth;
  feedback.pass = p.pass;
  feedback.x = p.position[kX];
  if (p.move == MoveKind::kStroke) {
    feedback.stroke_fraction =
        fraction(p.position[kX] - program.strokeFrom(), program.strokeTo() - program.strokeFrom());
  } else {
    feedback.stroke_fraction = p.move > MoveKind::kStroke ? 1 : 0;
  }
  feedback.job_fraction = fraction(done, all);
  feedback.remaining_time = std::max(0.0, all - done) * batch_.period;
  feedback.feed = p.feed;
  feedback.path_error = job_->largest_error;
  job_->largest_error = 0;
  job_->goal.publishFeedback(feedback);
}

}  // namespace flute_grinder
