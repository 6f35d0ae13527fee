#include "node/telemetry.h"

#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/reasons.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace grinder {

namespace {

constexpr double kTickPeriod = 0.01;         ///< time between joint states [s]
constexpr double kRestPeriod = 0.02;         ///< time between looks for a change, at rest [s]
const ros::WallDuration kRestDelay(1);       ///< time without a change until less is published
constexpr std::uint64_t kTicksPerBatch = 5;  ///< ticks between setpoints, state and feedback; at rest, joint states too
constexpr std::uint64_t kTicksPerScene = 10;  ///< ticks between updates of the job in rviz

double fraction(double done, double all) { return all == 0 ? 0 : std::clamp(done / all, 0.0, 1.0); }

/// How far a job has come, in cycles of its plan.
double plannedCycles(const Setpoint& p, const std::vector<std::uint64_t>& move_ends) {
  const auto begin = static_cast<double>(p.move_index == 0 ? 0 : move_ends[p.move_index - 1]);
  return begin + p.move_fraction * (static_cast<double>(move_ends[p.move_index]) - begin);
}

/// X reached in the stroke that the axes make, or from which the wheel was lifted [m].
double strokeX(const Setpoint& p, const GrindProgram& program) {
  if (p.move == MoveKind::kStroke) return p.position[kX];
  const FeedSchedule& schedule = program.schedule(p.tooth);
  return schedule.x(p.move_fraction * schedule.length());
}

double strokeFraction(const Setpoint& p, const GrindProgram& program) {
  const MoveKind move = program.moves()[p.move_index].kind;
  if (move != MoveKind::kStroke) return phaseOf(move) == PassPhase::kAfter ? 1 : 0;
  return fraction(strokeX(p, program) - program.strokeFrom(), program.strokeTo() - program.strokeFrom());
}

flute_grinder::JobProgress toMessage(const Progress& progress) {
  flute_grinder::JobProgress m;
  m.job_digest = progress.job_digest;
  m.job_name = progress.job_name;
  m.operation = progress.operation;
  m.cutter = grinder::toMessage(progress.cutter, progress.tooth_angles);
  m.finished = static_cast<std::uint8_t>(progress.finished);
  m.tooth = static_cast<std::uint16_t>(progress.next.tooth);
  m.pass = static_cast<std::uint16_t>(progress.next.pass);
  m.x = progress.x;
  m.end = progress.end;
  return m;
}

/// The name of the node that records a bag of this node; empty if none was asked for.
std::string recorderOf(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh) {
  const auto name = private_nh.param<std::string>("recorder", "");
  return name.empty() ? name : nh.resolveName(name);
}

/// The state of the power of a drive that hangs, in words.
const char* powerInWords(LoopWatchdog::Finding finding) {
  switch (finding) {
    case LoopWatchdog::Finding::kSwitchingOff: return "its powerOff() has not returned either";
    case LoopWatchdog::Finding::kHangsPowerIsOff: return "its power is switched off";
    case LoopWatchdog::Finding::kRuns:
    case LoopWatchdog::Finding::kHangs: break;
  }
  return "its power can only be switched off by hand";
}

}  // namespace

Telemetry::Telemetry(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, ControlLoop& loop,
                     const Journal& journal, const OffsetStore& offsets, History& history, const Tolerances& tolerances,
                     const MachineInfo& machine, const DiagnosticThresholds& thresholds, const MachineModel& model,
                     const FirstView& first_view)
    : loop_(loop),
      journal_(journal),
      offsets_(offsets),
      history_(history),
      diagnostics_(loop.config(), thresholds,
                   [&loop] {
                     return Scheduling{loop.realtimeScheduling(), loop.memoryLocked()};
                   }),
      diagnostic_updater_(nh, private_nh),
      recorder_watch_(recorderOf(nh, private_nh)),
      robot_status_(nh),
      frames_(model, first_view),
      scene_(private_nh, first_view),
      recorder_(private_nh.getNamespace(), machine, tolerances, history),
      thread_(kTickPeriod, [this] { tick(); }) {
  ros::NodeHandle node(nh), own(private_nh);
  joint_states_ = node.advertise<sensor_msgs::JointState>("joint_states", 10);
  state_ = own.advertise<flute_grinder::GrinderState>("state", 10, true);
  own.setCallbackQueue(thread_.queue());
  setpoints_ = own.advertise<flute_grinder::SetpointBatch>(
      "setpoints", 1000, [this](const auto& peer) { recorder_watch_.connect(peer.getSubscriberName()); },
      [this](const auto& peer) { recorder_watch_.disconnect(peer.getSubscriberName()); });
  diagnostic_updater_.setHardwareID(own.param<std::string>("hardware/type", ""));
  diagnostics_.addTo(diagnostic_updater_);
  recorder_watch_.addTo(diagnostic_updater_);
  diagnostics_period_ = ros::WallDuration(std::clamp(diagnostic_updater_.getPeriod(), kTickPeriod, 3600.0));
  next_diagnostics_ = ros::SteadyTime::now() + diagnostics_period_;
  batch_.period = loop.config().machine.period;
}

Telemetry::~Telemetry() {
  thread_.stop();
  // Its subscribers are reported to the thread's queue.
  setpoints_.shutdown();
}

void Telemetry::show(std::shared_ptr<const PlannedJob> plan, const std::string& job_name) {
  thread_.post([this, plan = std::move(plan), job_name, offsets = offsets_.offsets()] {
    // While a job runs, that job is shown.
    if (!jobs_.empty() || scene_cleared_) return;
    showJob(*plan, job_name, false);
    shown_with_ = offsets;
  });
}

void Telemetry::announceJob(std::uint64_t number, const std::string& goal_id, const std::string& job_name,
                            std::shared_ptr<const PlannedJob> plan, std::shared_ptr<JobRecord> record) {
  thread_.post([this, number, goal_id, job_name, plan = std::move(plan), record = std::move(record)] {
    jobs_.push_back({number, goal_id, job_name, plan});
    recorder_.announce(number, record);
  });
}

void Telemetry::withdrawJob(std::uint64_t number) {
  thread_.post([this, number] {
    if (jobs_.empty() || jobs_.back().number != number) return;
    jobs_.pop_back();
    recorder_.withdraw(number);
  });
}

void Telemetry::concludeJob(std::uint64_t number, const JobConclusion& conclusion) {
  thread_.post([this, number, conclusion] { recorder_.conclude(number, conclusion); });
}

void Telemetry::clearScene() {
  thread_.post([this] {
    scene_cleared_ = true;
    for (Job& job : jobs_) job.shown = false;
    shown_with_.reset();
    scene_.clear();
  });
}

/// @param ground whether the plan's job begins; if not, it is only planned.
void Telemetry::showJob(const PlannedJob& plan, const std::string& name, bool ground) {
  const GrindJob& job = *plan.program->job();
  const std::string operation = job.operationText();
  last_change_ = ros::SteadyTime::now();
  shown_with_.reset();
  frames_.show(plan.program, plan.edges);
  scene_.show(plan.program, plan.edges, plan.program->job().digest(), plan.program->run().first,
              (ground ? "Ground: " : "Planned: ") + jobText(name, operation, job.cutter, job.tooth_angles.size()));
}

/// Removes the plan from rviz once its zero points or the wheel have changed: it would be shown in the wrong place.
void Telemetry::discardStalePlan() {
  if (!shown_with_ || !jobs_.empty()) return;
  const WorkOffsets offsets = offsets_.offsets();
  const Axes now = offsets.values(), then = shown_with_->values();
  if ((now == then).all() && offsets.wheel.mounting == shown_with_->wheel.mounting) return;
  shown_with_.reset();
  scene_.discard();
}

void Telemetry::tick() {
  readRecords();
  logHang();
  if (samples_read_ == 0) return;
  recorder_watch_.look(ros::SteadyTime::now());
  Job* job = running();
  if (job && !job->shown && !scene_cleared_) {
    showJob(*job->plan, job->name, true);
    job->shown = true;
  }
  const bool begins = setPace();
  const bool batch_due = ++ticks_ % kTicksPerBatch == 0 || begins;
  if (batch_due || !resting_) {
    publishJointStates();
    frames_.publish(sample_.position, offsets_.offsets().values(), job ? job->last.tooth : 0, ros::Time(sample_.time));
  }
  if (batch_due) {
    discardStalePlan();
    publishBatch();
    publishState();
    makeFeedback();
  }
  if (ticks_ % kTicksPerScene == 0 && !scene_cleared_) {
    scene_.greet();
    if (job && job->shown) scene_.update();
  }
  publishDiagnostics();
}

/// Looks for changes. Without changes and without a job the pace is slower.
/// @return whether a change ends the rest.
bool Telemetry::setPace() {
  const ros::SerializedMessage state = ros::serialization::serializeMessage(stateMessage());
  const bool changed = !last_state_.buf || state.num_bytes != last_state_.num_bytes ||
                       std::memcmp(state.buf.get(), last_state_.buf.get(), state.num_bytes) != 0;
  last_state_ = state;
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (changed || !jobs_.empty()) last_change_ = now;
  const bool rested = resting_;
  resting_ = now - last_change_ > kRestDelay;
  thread_.setPeriod(resting_ ? kRestPeriod : kTickPeriod);
  return rested && !resting_;
}

void Telemetry::publishDiagnostics() {
  // The system clock may be set back.
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (now < next_diagnostics_) return;
  next_diagnostics_ = std::max(next_diagnostics_ + diagnostics_period_, now);
  diagnostics_.setJournalError(journal_.status().error);
  diagnostics_.setHistoryError(history_.error());
  diagnostic_updater_.force_update();
}

Telemetry::Job* Telemetry::running() { return jobs_.empty() ? nullptr : &jobs_.front(); }

void Telemetry::readRecords() {
  while (loop_.pop(sample_)) {
    ++samples_read_;
    processRecord();
  }
}

void Telemetry::processRecord() {
  diagnostics_.add(sample_);
  logFault();
  // If the sample of a job's end was lost, a sample of a later job ends that job.
  while (jobs_.size() > 1 && sample_.job > jobs_.front().number) endJob(jobs_.front());
  if (!jobs_.empty() && sample_.job == jobs_.front().number) trackJob(jobs_.front());
}

void Telemetry::logHang() {
  const LoopWatchdog::Finding finding = watchdog_->finding();
  if (std::exchange(finding_, finding) == finding) return;
  if (finding == LoopWatchdog::Finding::kRuns) {
    ROS_WARN("the drive has returned to the control loop");
  } else {
    ROS_ERROR_STREAM(hang().text());
  }
}

LoopFault Telemetry::hang() const {
  LoopFault fault;
  fault.kind = FaultKind::kDriveFault;
  fault.drive_text = "it does not return to the control loop; ";
  fault.drive_text += powerInWords(finding_);
  return fault;
}

/// Replaces the loop's last state by the fault of the hang.
void Telemetry::replaceByHang(flute_grinder::GrinderState& message) const {
  const LoopFault fault = hang();
  message.state = static_cast<std::uint8_t>(MachineState::kFault);
  message.state_name = toString(MachineState::kFault);
  message.enabled = static_cast<std::uint8_t>(finding_ != LoopWatchdog::Finding::kHangsPowerIsOff);
  message.fault = fault.text();
  message.fault_reason = grinder::toMessage(reasonOf(fault));
}

/// Logs a new fault, unless it ended a job: then the goal's end is logged.
void Telemetry::logFault() {
  const bool in_fault = sample_.state == MachineState::kFault;
  if (in_fault && !in_fault_ && !sample_.job_ended) ROS_ERROR_STREAM("fault without a job: " << sample_.fault.text());
  in_fault_ = in_fault;
}

void Telemetry::trackJob(Job& job) {
  JobRecord& job_record = recorder_.of(job.number);
  job_record.addCycle(sample_);
  if (sample_.has_setpoint) job.buffered.push_back({cycle(), sample_.period, sample_.setpoint});
  // A drive may buffer commands: publish a setpoint with the positions of the cycle before it reaches the axes.
  auto& buffered = job.buffered;
  while (!buffered.empty() && buffered.front().cycle + sample_.drive.commands_waiting <= cycle()) {
    job.last = buffered.front().setpoint;
    if (job.shown) scene_.add(job.last, workPosition(job));
    job_record.addSetpoint(job.last, sample_);
    addToBatch(job, buffered.front());
    buffered.pop_front();
  }
  if (sample_.job_ended) endJob(job);
}

void Telemetry::addToBatch(Job& job, const Buffered& written) {
  const Setpoint& setpoint = written.setpoint;
  const std::uint64_t lost = setpoint.cycle - job.next_cycle;
  job.next_cycle = setpoint.cycle + 1;
  recorder_.of(job.number).addLost(lost);
  if (lost > 0) publishBatch();
  if (batch_.setpoints.empty()) {
    batch_.header.stamp = ros::Time(sample_.time);
    batch_.goal_id = job.goal_id;
    batch_.lost = lost;
  }
  batch_.setpoints.push_back(toMessage(setpoint, workPosition(job), written.period));
  batch_.end_stamp = ros::Time(sample_.time);
  job.max_error = std::max(job.max_error, std::abs(setpoint.path_error));
}

/// The position read, in the job's work coordinates.
Axes Telemetry::workPosition(const Job& job) const { return sample_.position - job.plan->program->run().offset; }

void Telemetry::endJob(Job& job) {
  // Setpoints that were written but never reached the axes.
  for (const Buffered& unplayed : job.buffered) addToBatch(job, unplayed);
  publishBatch();
  makeFeedback();
  if (job.shown) scene_.end();
  const std::uint64_t number = job.number;
  recorder_.end(number);
  jobs_.pop_front();
  publishState();
  jobs_published_ = number;
}

void Telemetry::publishJointStates() {
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(sample_.time);
  for (int i = 0; i < kAxisCount; ++i) {
    message.name.emplace_back(kJointNames[static_cast<std::size_t>(i)]);
    message.position.push_back(sample_.position[i]);
    message.velocity.push_back(sample_.velocity[i]);
  }
  joint_states_.publish(message);
}

void Telemetry::publishBatch() {
  if (batch_.setpoints.empty()) return;
  setpoints_.publish(batch_);
  batch_.setpoints.clear();
}

void Telemetry::publishState() {
  flute_grinder::GrinderState message = stateMessage();
  message.header.stamp = ros::Time(sample_.time);
  state_.publish(message);
  robot_status_.publish(message);
}

/// The state, without a stamp.
flute_grinder::GrinderState Telemetry::stateMessage() const {
  flute_grinder::GrinderState message;
  message.state = static_cast<std::uint8_t>(sample_.state);
  message.state_name = toString(sample_.state);
  message.enabled = sample_.drive.enabled;
  message.power_stays_on = static_cast<std::uint8_t>(sample_.power_stays);
  message.homed = sample_.drive.homed;
  message.spindle_at_speed = sample_.drive.spindle_at_speed;
  message.coolant_on = sample_.drive.coolant_on;
  message.spindle_commanded = sample_.spindle_commanded;
  message.coolant_commanded = sample_.coolant_commanded;
  message.emergency_stop = sample_.drive.emergency_stop;
  message.wheel_in_work = sample_.wheel_in_work;
  message.swivel = sample_.swivel.angle;
  message.swivel_measured = sample_.swivel.measured;
  message.probe_contact = sample_.drive.probe_contact;
  message.override = sample_.feed_override;
  const Axes offset = offsets_.offsets().values();
  for (int axis = 0; axis < kAxisCount; ++axis) {
    message.position[static_cast<std::size_t>(axis)] = sample_.position[axis];
    message.distance_to_go[static_cast<std::size_t>(axis)] = sample_.distance_to_go[axis];
    message.work_position[static_cast<std::size_t>(axis)] = sample_.position[axis] - offset[axis];
  }
  if (!jobs_.empty()) {
    const Setpoint& last = jobs_.front().last;
    message.feed = last.feed;
    message.tooth = last.tooth;
    message.pass = last.pass;
  }
  const Reason fault = reasonOf(sample_.fault);
  message.fault = text(fault);
  message.fault_reason = grinder::toMessage(fault);
  message.hold_reason = toString(sample_.interlock);
  if (finding_ != LoopWatchdog::Finding::kRuns) replaceByHang(message);
  const Journal::Status journal = journal_.status();
  message.progress = toMessage(journal.on_disk);
  message.journal_error = journal.error;
  message.journal_damaged = static_cast<std::uint8_t>(!journal.damage.empty());
  return message;
}

void Telemetry::makeFeedback() {
  Job* job = running();
  if (!job) return;
  const Setpoint& p = job->last;
  const PlannedJob& plan = *job->plan;
  const double done = plannedCycles(p, plan.move_ends);
  const auto all = static_cast<double>(plan.move_ends.back());
  flute_grinder::GrindFeedback feedback;
  feedback.state = toString(sample_.state);
  feedback.planned = 1;
  feedback.tooth = p.tooth;
  feedback.pass = p.pass;
  feedback.x = p.position[kX];
  feedback.stroke_fraction = strokeFraction(p, *plan.program);
  feedback.job_fraction = fraction(done, all);
  feedback.remaining_time = std::max(0.0, all - done) * batch_.period;
  feedback.feed = p.feed;
  feedback.path_error = job->max_error;
  job->max_error = 0;
  const std::lock_guard<std::mutex> lock(feedback_mutex_);
  if (feedback_ && feedback_number_ == job->number) {
    feedback.path_error = std::max(feedback.path_error, feedback_->path_error);
  }
  feedback_number_ = job->number;
  feedback_ = std::move(feedback);
}

std::optional<flute_grinder::GrindFeedback> Telemetry::takeFeedback(std::uint64_t number) {
  const std::lock_guard<std::mutex> lock(feedback_mutex_);
  if (feedback_number_ != number) return std::nullopt;
  return std::exchange(feedback_, std::nullopt);
}

}  // namespace grinder
