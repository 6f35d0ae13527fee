#include "node/telemetry.h"

#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/reasons.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace grinder {

namespace {

constexpr double kTickPeriod = 0.01;         ///< time between joint states [s]
constexpr double kRestPeriod = 0.02;         ///< time between looks for a change, at rest [s]
const ros::WallDuration kRestDelay(1);       ///< time without a change until less is published
constexpr std::uint64_t kTicksPerBatch = 5;  ///< ticks between setpoints, state and feedback; at rest, joint states too
constexpr std::uint64_t kTicksPerScene = 10;  ///< ticks between updates of the job in rviz

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
      jobs_(private_nh, loop.config().machine.period, machine, tolerances, history, first_view, frames_,
            [this] { publishState(); }),
      thread_(kTickPeriod, [this] { tick(); }) {
  ros::NodeHandle node(nh), own(private_nh);
  joint_states_ = node.advertise<sensor_msgs::JointState>("joint_states", 10);
  state_ = own.advertise<flute_grinder::GrinderState>("state", 10, true);
  own.setCallbackQueue(thread_.queue());
  jobs_.advertise(own, recorder_watch_);
  diagnostic_updater_.setHardwareID(own.param<std::string>("hardware/type", ""));
  diagnostics_.addTo(diagnostic_updater_);
  recorder_watch_.addTo(diagnostic_updater_);
  diagnostics_period_ = ros::WallDuration(std::clamp(diagnostic_updater_.getPeriod(), kTickPeriod, 3600.0));
  next_diagnostics_ = ros::SteadyTime::now() + diagnostics_period_;
}

Telemetry::~Telemetry() {
  thread_.stop();
  jobs_.shutDown();
}

void Telemetry::show(std::shared_ptr<const PlannedJob> plan, const std::string& job_name) {
  thread_.post([this, plan = std::move(plan), job_name, offsets = offsets_.offsets()] {
    if (jobs_.showPlan(*plan, job_name, offsets)) last_change_ = ros::SteadyTime::now();
  });
}

void Telemetry::announceJob(std::uint64_t number, const std::string& goal_id, const std::string& job_name,
                            std::shared_ptr<const PlannedJob> plan, std::shared_ptr<JobRecord> record) {
  thread_.post([this, number, goal_id, job_name, plan = std::move(plan), record = std::move(record)] {
    jobs_.announce(number, goal_id, job_name, plan, record);
  });
}

void Telemetry::withdrawJob(std::uint64_t number) {
  thread_.post([this, number] { jobs_.withdraw(number); });
}

void Telemetry::concludeJob(std::uint64_t number, const JobConclusion& conclusion) {
  thread_.post([this, number, conclusion] { jobs_.conclude(number, conclusion); });
}

void Telemetry::clearScene() {
  thread_.post([this] { jobs_.clearScene(); });
}

void Telemetry::tick() {
  readSamples();
  logHang();
  if (samples_read_ == 0) return;
  recorder_watch_.look(ros::SteadyTime::now());
  jobs_.showRunning();
  const bool begins = setPace();
  const bool batch_due = ++ticks_ % kTicksPerBatch == 0 || begins;
  if (batch_due || !resting_) {
    publishJointStates();
    const Setpoint* last = jobs_.last();
    frames_.publish(sample_.position, offsets_.offsets().values(), last ? last->tooth : 0, ros::Time(sample_.time));
  }
  if (batch_due) {
    jobs_.discardStalePlan(offsets_.offsets());
    jobs_.publishBatch();
    publishState();
    jobs_.makeFeedback(sample_);
  }
  if (ticks_ % kTicksPerScene == 0) jobs_.updateScene();
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

void Telemetry::readSamples() {
  while (loop_.pop(sample_)) {
    ++samples_read_;
    diagnostics_.add(sample_);
    logFault();
    jobs_.add(sample_, samples_read_ + sample_.samples_lost);
  }
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
  message.wheel_backs_off = sample_.wheel_backs_off;
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
  if (const Setpoint* last = jobs_.last()) {
    message.feed = last->feed;
    message.tooth = last->tooth;
    message.pass = last->pass;
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

}  // namespace grinder
