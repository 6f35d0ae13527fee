#include "flute_grinder/control/drive_checks.h"

#include <cmath>

namespace flute_grinder {

Refusal DriveChecks::powerRefusal(const CycleRecord& record) const noexcept {
  if (record.drive.emergency_stop) return Refusal::kEmergencyStop;
  if (record.drive.fault) return Refusal::kDriveFault;
  if (!record.position.isFinite().all() || !feedbackIsFresh(record)) return Refusal::kFeedback;
  return Refusal::kNone;
}

std::optional<LoopFault> DriveChecks::findFault(const CycleRecord& record, bool moving_unbuffered) const noexcept {
  LoopFault fault;
  if (record.drive.emergency_stop) {
    fault.kind = FaultKind::kEmergencyStop;
    return fault;
  }
  // Checked before drive fault and lost power, which may be the drive's reaction to underruns and late cycles.
  if (record.drive.underruns != underruns_at_power_on_) {
    fault.kind = FaultKind::kUnderrun;
    fault.value = static_cast<double>(record.drive.underruns - underruns_at_power_on_);
    fault.cycle = record.setpoint.cycle;
    return fault;
  }
  const double longest = config_.late_fault * config_.machine.period;
  if (moving_unbuffered && !(record.period <= longest)) {
    fault.kind = FaultKind::kLate;
    fault.value = record.period;
    fault.limit = longest;
    return fault;
  }
  if (record.drive.fault) {
    fault.kind = FaultKind::kDriveFault;
    return fault;
  }
  if (!record.drive.enabled) {
    fault.kind = FaultKind::kPowerLost;
    return fault;
  }
  return findFeedbackFault(record);
}

bool DriveChecks::feedbackIsFresh(const CycleRecord& record) const noexcept {
  return record.feedback_age <= config_.feedback_timeout;
}

std::optional<LoopFault> DriveChecks::findFeedbackFault(const CycleRecord& record) const noexcept {
  LoopFault fault;
  if (!feedbackIsFresh(record)) {
    fault.kind = FaultKind::kStaleFeedback;
    fault.value = record.feedback_age;
    fault.limit = config_.feedback_timeout;
    return fault;
  }
  for (int i = 0; i < kAxisCount; ++i) {
    fault.axis = i;
    if (!std::isfinite(record.position[i])) {
      fault.kind = FaultKind::kInvalidFeedback;
      fault.value = record.position[i];
      return fault;
    }
    const double error = std::abs(record.command_in_effect[i] - record.position[i]);
    if (!(error <= config_.following_error[i])) {
      fault.kind = FaultKind::kFollowingError;
      fault.value = error;
      fault.limit = config_.following_error[i];
      return fault;
    }
  }
  return std::nullopt;
}

Interlock openInterlock(const DriveStatus& drive) noexcept {
  if (!drive.homed) return Interlock::kNotHomed;
  if (!drive.spindle_at_speed) return Interlock::kSpindle;
  if (!drive.coolant_on) return Interlock::kCoolant;
  if (!drive.probe_free) return Interlock::kProbe;
  return Interlock::kNone;
}

}  // namespace flute_grinder
