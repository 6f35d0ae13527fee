#include "flute_grinder/control/drive_checks.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

constexpr double kAveraged = 1;  ///< time over which the cycles' periods are averaged [s]
/// The longest average cycle, as a fraction of the cycle from which the axes are slowed down. By default this is 1.6
/// periods, well below the 2 periods of a loop that runs at half its rate.
constexpr double kLongest = 0.8;

/// @param value value that exceeds `limit`. @param axis axis to which it belongs.
LoopFault faultOf(FaultKind kind, double value = 0, double limit = 0, int axis = 0) noexcept {
  LoopFault fault;
  fault.kind = kind;
  fault.axis = axis;
  fault.value = value;
  fault.limit = limit;
  return fault;
}

}  // namespace

void DriveChecks::observe(const CycleSample& sample) noexcept {
  // A fault that comes after the present one has cleared is a new one.
  was_reset_ = was_reset_ && sample.drive.fault;
  time_ += sample.period;
  bounded_time_ +=
      std::min(sample.period, config_.late_slow_down * config_.machine.period);  // limits the weight of a stall
  ++cycles_;
  if (bounded_time_ < kAveraged) return;
  slow_ = bounded_time_ > cycles_ * longestOnAverage() ? time_ / cycles_ : 0;
  time_ = bounded_time_ = cycles_ = 0;
}

double DriveChecks::longestOnAverage() const noexcept {
  return kLongest * config_.late_slow_down * config_.machine.period;
}

Refusal DriveChecks::powerRefusal(const CycleSample& sample) const noexcept {
  if (sample.drive.emergency_stop) return Refusal::kEmergencyStop;
  if (sample.drive.fault) return was_reset_ ? Refusal::kDriveFaultStays : Refusal::kDriveFault;
  if (!sample.position.isFinite().all() || !feedbackIsFresh(sample)) return Refusal::kFeedback;
  return Refusal::kNone;
}

std::optional<LoopFault> DriveChecks::findFault(const CycleSample& sample, bool moving_unbuffered) const noexcept {
  if (sample.drive.emergency_stop) return faultOf(FaultKind::kEmergencyStop);
  // Checked before drive fault and lost power, which may be the drive's reaction to underruns and late cycles.
  if (sample.drive.underruns != underruns_at_power_on_) {
    const auto count = static_cast<double>(sample.drive.underruns - underruns_at_power_on_);
    LoopFault fault = faultOf(FaultKind::kUnderrun, count);
    fault.cycle = sample.setpoint.cycle;
    return fault;
  }
  const double longest = config_.late_fault * config_.machine.period;
  if (moving_unbuffered && !(sample.period <= longest)) return faultOf(FaultKind::kLate, sample.period, longest);
  if (sample.drive.fault) {
    LoopFault fault = faultOf(FaultKind::kDriveFault);
    fault.drive_text = sample.drive.fault_text;
    return fault;
  }
  if (!sample.drive.enabled) return faultOf(FaultKind::kPowerLost);
  if (slow_ > 0) return faultOf(FaultKind::kSlow, slow_, longestOnAverage());
  return findFeedbackFault(sample);
}

bool DriveChecks::feedbackIsFresh(const CycleSample& sample) const noexcept {
  return sample.feedback_age <= config_.feedback_timeout;
}

std::optional<LoopFault> DriveChecks::findFeedbackFault(const CycleSample& sample) const noexcept {
  if (!feedbackIsFresh(sample)) {
    return faultOf(FaultKind::kStaleFeedback, sample.feedback_age, config_.feedback_timeout);
  }
  for (int i = 0; i < kAxisCount; ++i) {
    const double position = sample.position[i];
    if (!std::isfinite(position)) return faultOf(FaultKind::kInvalidFeedback, position, 0, i);
    const double error = sample.followingError(i);
    const double allowed = config_.following_error[i];
    if (!(error <= allowed)) return faultOf(FaultKind::kFollowingError, error, allowed, i);
  }
  return std::nullopt;
}

Interlock openInterlock(const DriveStatus& drive, bool spindle, bool coolant) noexcept {
  if (!drive.homed) return Interlock::kNotHomed;
  if (!drive.spindle_at_speed || !spindle) return Interlock::kSpindle;
  if (!drive.coolant_on || !coolant) return Interlock::kCoolant;
  if (!drive.probe_free) return Interlock::kProbe;
  return Interlock::kNone;
}

}  // namespace grinder
