#include "node/diagnostics.h"

#include "flute_grinder/record/cycle_figures.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace grinder {

namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kPercent = 0.01;
constexpr int kSetpointsOfPast = 8;  ///< setpoints on which acceleration and jerk at the end of a pair depend
constexpr std::array<const char*, 4> kQuantityNames{"position", "velocity", "acceleration", "jerk"};

/// The level of a quantity with upper thresholds; NaN exceeds both.
unsigned char levelAbove(double value, const DiagnosticLevels& levels) {
  if (!(value <= levels.error)) return DiagnosticStatus::ERROR;
  return value <= levels.warn ? DiagnosticStatus::OK : DiagnosticStatus::WARN;
}

unsigned char levelBelow(double value, const DiagnosticLevels& levels) {
  return levelAbove(-value, {-levels.warn, -levels.error});
}

std::string joint(int axis) { return kJointNames[static_cast<std::size_t>(axis)]; }

/// Reports whether data are kept on disk. @param error why not; empty if they are.
void reportKept(Diagnostics::Status& status, const std::string& error, unsigned char level) {
  if (error.empty()) {
    status.summary(DiagnosticStatus::OK, "kept");
  } else {
    status.summary(level, error);
  }
}

/// @param of name of the durations, in lower case.
void addDurations(Diagnostics::Status& status, const std::string& of, const Durations& durations) {
  status.add("Median " + of + " [s]", durations.quantile(0.5));
  status.add("99 % " + of + " [s]", durations.quantile(0.99));
  status.add("Longest " + of + " [s]", durations.longest());
}

template <typename... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

}  // namespace

Diagnostics::Diagnostics(const LoopConfig& config, const DiagnosticThresholds& thresholds,
                         std::function<Scheduling()> scheduling)
    : config_(config),
      thresholds_(thresholds),
      scheduling_(std::move(scheduling)),
      limit_check_(config.machine.limits, config.machine.period) {}

void Diagnostics::addTo(diagnostic_updater::Updater& updater) {
  updater.add("Control loop", this, &Diagnostics::reportLoop);
  updater.add("Drive link", this, &Diagnostics::reportDrive);
  updater.add("Following error", this, &Diagnostics::reportFollowing);
  updater.add("Limit margin", this, &Diagnostics::reportLimits);
  updater.add("Buffer", this, &Diagnostics::reportBuffer);
  updater.add("Journal", this, &Diagnostics::reportJournal);
  updater.add("History", this, &Diagnostics::reportHistory);
}

void Diagnostics::add(const CycleSample& sample) {
  ++loop_.cycles;
  loop_.total += sample.period;
  updateMax(loop_.longest, sample.period);
  if (isLate(sample.period, config_.machine.period)) ++loop_.late;
  loop_.busy.add(sample.busy);
  loop_.delay.add(sample.period - config_.machine.period);

  addDrive(sample);
  const bool was_powered = isPowered(last_.state);
  if (!was_powered && isPowered(sample.state)) fullest_ = 0;
  // The cycle that ends in a fault still shows its cause.
  if (was_powered || isPowered(sample.state)) {
    for (int i = 0; i < kAxisCount; ++i) updateMax(following_error_[i], sample.followingError(i));
    addBuffer(sample.drive);
  }
  if (sample.has_setpoint) addSetpoint(sample.setpoint, sample.command);
  if (was_powered && sample.fault.kind == FaultKind::kLimit && sample.state == MachineState::kFault) {
    addViolation(sample.fault.violation);
  }
  last_ = sample;
}

void Diagnostics::addDrive(const CycleSample& sample) {
  const DriveStatus& drive = sample.drive;
  updateMax(drive_.feedback_age, sample.feedback_age);
  drive_.emergency_stop |= drive.emergency_stop;
  drive_.fault |= drive.fault;
  if (drive.fault) drive_.fault_text = drive.fault_text;
  if (sample.interlock != Interlock::kNone) drive_.interlock = sample.interlock;
  if (sample.state == MachineState::kFault) drive_.loop_fault = sample.fault;
  for (int i = 0; i < kAxisCount; ++i) {
    if (std::isfinite(drive_.position[i])) drive_.position[i] = sample.position[i];
  }
}

void Diagnostics::addSetpoint(const Setpoint& setpoint, const Axes& command) {
  if (setpoint.cycle == 0 || setpoint.cycle != next_setpoint_) {
    limit_check_.restart();
    unknown_setpoints_ = setpoint.cycle == 0 ? 0 : kSetpointsOfPast;
  }
  next_setpoint_ = setpoint.cycle + 1;
  static_cast<void>(limit_check_.check(setpoint));
  if (unknown_setpoints_ > 0) {
    --unknown_setpoints_;
    return;
  }
  ++limits_.setpoints;
  const AxisLimits& limits = config_.machine.limits;
  for (int i = 0; i < kAxisCount; ++i) {
    updateMax(limits_.use[0][i], positionUse(i, command[i]));
    updateMax(limits_.use[1][i], std::abs(limit_check_.velocity()[i]) / limits.max_velocity[i]);
    if (setpoint.cycle % 2 != 0) continue;  // within a pair, odd and even steps alternate
    updateMax(limits_.use[2][i], std::abs(limit_check_.acceleration()[i]) / limits.max_acceleration[i]);
    updateMax(limits_.use[3][i], std::abs(limit_check_.jerk()[i]) / limits.max_jerk[i]);
  }
}

void Diagnostics::addViolation(const LimitViolation& v) {
  ++limits_.setpoints;
  const bool of_position = v.quantity == LimitedQuantity::kPosition || v.quantity == LimitedQuantity::kNotFinite;
  const std::size_t quantity = of_position ? 0 : static_cast<std::size_t>(v.quantity);
  updateMax(limits_.use[quantity][v.axis], of_position ? positionUse(v.axis, v.value) : std::abs(v.value) / v.limit);
}

double Diagnostics::positionUse(int axis, double position) const {
  const double min = config_.machine.limits.min_position[axis];
  const double max = config_.machine.limits.max_position[axis];
  return std::abs(2 * position - min - max) / (max - min);
}

void Diagnostics::addBuffer(const DriveStatus& drive) {
  fullest_ = std::max(fullest_, drive.commands_waiting);
  buffer_.min = buffer_.used ? std::min(buffer_.min, drive.commands_waiting) : drive.commands_waiting;
  buffer_.used = true;
}

void Diagnostics::reportLoop(Status& status) {
  const Scheduling granted = scheduling_();
  const auto cycles = static_cast<double>(loop_.cycles);
  const std::uint64_t lost = last_.samples_lost - samples_lost_;
  status.summary(DiagnosticStatus::OK, "running");
  if (loop_.cycles == 0) {
    status.mergeSummary(DiagnosticStatus::ERROR, "not running");
  } else {
    status.mergeSummary(levelAbove(static_cast<double>(loop_.late) / cycles, thresholds_.late_cycles),
                        text(loop_.late, " of ", loop_.cycles, " cycles were late"));
  }
  if (lost > 0) status.mergeSummary(DiagnosticStatus::ERROR, text(lost, " cycle samples were lost"));
  if (!granted.realtime) status.mergeSummary(DiagnosticStatus::WARN, "no real-time scheduling");
  if (!granted.memory_locked) status.mergeSummary(DiagnosticStatus::WARN, "memory is not locked");
  status.add("State", toString(last_.state));
  status.add("Nominal period [s]", config_.machine.period);
  status.add("Mean period [s]", loop_.cycles > 0 ? loop_.total / cycles : 0);
  status.add("Longest period [s]", loop_.longest);
  addDurations(status, "cycle duration", loop_.busy);
  addDurations(status, "wake-up delay", loop_.delay);
  status.add("Cycles", loop_.cycles);
  status.add("Late cycles", loop_.late);
  status.add("Samples lost", last_.samples_lost);
  status.add("Real-time scheduling", granted.realtime);
  status.add("Memory locked", granted.memory_locked);
  samples_lost_ = last_.samples_lost;
  loop_ = {};
}

void Diagnostics::reportDrive(Status& status) {
  const FaultKind reported = drive_.loop_fault.kind;
  status.summary(DiagnosticStatus::OK, last_.drive.enabled ? "enabled" : "disabled");
  if (reported != FaultKind::kNone) status.mergeSummary(DiagnosticStatus::ERROR, drive_.loop_fault.text());
  if (last_.power_stays) {
    status.mergeSummary(DiagnosticStatus::ERROR, "the drive still reports power, though it was switched off");
  }
  if (drive_.emergency_stop && reported != FaultKind::kEmergencyStop) {
    status.mergeSummary(DiagnosticStatus::ERROR, "emergency stop");
  }
  if (drive_.fault && reported != FaultKind::kDriveFault) {
    LoopFault fault;
    fault.kind = FaultKind::kDriveFault;
    fault.drive_text = drive_.fault_text;
    status.mergeSummary(DiagnosticStatus::ERROR, fault.text());
  }
  if (!(drive_.feedback_age <= config_.feedback_timeout) && reported != FaultKind::kStaleFeedback) {
    status.mergeSummary(DiagnosticStatus::ERROR, text("no fresh positions for ", drive_.feedback_age, " s"));
  }
  for (int i = 0; i < kAxisCount; ++i) {
    if (std::isfinite(drive_.position[i])) continue;
    status.mergeSummary(DiagnosticStatus::ERROR, text(joint(i), " position is ", drive_.position[i]));
  }
  if (!last_.drive.homed) status.mergeSummary(DiagnosticStatus::WARN, "not homed");
  if (drive_.interlock != Interlock::kNone) status.mergeSummary(DiagnosticStatus::WARN, toString(drive_.interlock));
  status.add("Enabled", last_.drive.enabled);
  status.add("Homed", last_.drive.homed);
  status.add("Emergency stop", drive_.emergency_stop);
  status.add("Drive fault", drive_.fault);
  status.add("Longest feedback age [s]", drive_.feedback_age);
  status.add("Allowed feedback age [s]", config_.feedback_timeout);
  drive_ = {};
}

void Diagnostics::reportFollowing(Status& status) {
  status.summary(DiagnosticStatus::OK, "within the thresholds");
  for (int i = 0; i < kAxisCount; ++i) {
    const double allowed = config_.following_error[i];
    const double fraction = following_error_[i] / allowed;
    const std::string unit = axisUnit(i);
    status.mergeSummary(levelAbove(fraction, thresholds_.following_error),
                        text(joint(i), " ", following_error_[i], " ", unit, " of ", allowed, " ", unit));
    status.add(joint(i) + " max [" + unit + "]", following_error_[i]);
    status.add(joint(i) + " of the allowed [%]", fraction / kPercent);
  }
  following_error_.setZero();
}

void Diagnostics::reportLimits(Status& status) {
  status.summary(DiagnosticStatus::OK, limits_.setpoints > 0 ? "within the thresholds" : "no setpoints");
  status.add("Setpoints", limits_.setpoints);
  for (std::size_t q = 0; q < kQuantityNames.size() && limits_.setpoints > 0; ++q) {
    for (int i = 0; i < kAxisCount; ++i) {
      const double use = limits_.use[q][i];
      const std::string name = joint(i) + " " + kQuantityNames[q];
      status.mergeSummary(levelAbove(use, thresholds_.limit_use),
                          text(name, " at ", use / kPercent, " % of its limit"));
      status.add(name + " margin [%]", (1 - use) / kPercent);
    }
  }
  limits_ = {};
}

void Diagnostics::reportBuffer(Status& status) {
  const std::uint64_t underruns = last_.drive.underruns - underruns_;
  status.summary(DiagnosticStatus::OK, "filled");
  if (fullest_ == 0) {
    status.summary(DiagnosticStatus::OK, "the drive does not buffer");
  } else if (!buffer_.used) {
    status.summary(DiagnosticStatus::OK, "no power");
  } else {
    const double fill = static_cast<double>(buffer_.min) / fullest_;
    status.mergeSummary(levelBelow(fill, thresholds_.buffer_fill),
                        text("down to ", buffer_.min, " of ", fullest_, " commands"));
    status.add("Minimum fill [%]", fill / kPercent);
  }
  if (underruns > 0) status.mergeSummary(DiagnosticStatus::ERROR, text(underruns, " underruns"));
  status.add("Commands waiting", last_.drive.commands_waiting);
  status.add("Underruns", last_.drive.underruns);
  underruns_ = last_.drive.underruns;
  buffer_ = {};
}

void Diagnostics::reportJournal(Status& status) { reportKept(status, journal_error_, DiagnosticStatus::ERROR); }

void Diagnostics::reportHistory(Status& status) { reportKept(status, history_error_, DiagnosticStatus::WARN); }

}  // namespace grinder
