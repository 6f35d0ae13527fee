#include "flute_grinder/control/power.h"

namespace grinder {

void Power::observe(CycleSample& sample) noexcept {
  unwanted_ = sample.drive.enabled && !commanded_ ? unwanted_ + sample.period : 0;
  sample.power_stays = !(unwanted_ <= config_.enable_timeout);
  Call call = call_;
  has_hung_ = call != Call::kNone;
  if (!has_hung_) return;
  sample.drive.fault = true;
  sample.drive.fault_text = "it has returned to the control loop too late";
  if (call == Call::kInProgress) sample.drive.fault_text += "; its powerOff() has not returned";
  // A second call may have begun meanwhile: it stays.
  if (call == Call::kReturned) call_.compare_exchange_strong(call, Call::kNone);
}

Refusal Power::begin(const CycleSample& sample) noexcept {
  const Refusal refusal = checks_.powerRefusal(sample);
  if (refusal != Refusal::kNone || isPowered(sample.state)) return refusal;
  awaited_ = true;
  preparation_begun_ = false;
  waited_ = 0;
  return Refusal::kNone;
}

std::optional<Refusal> Power::await(const CycleSample& sample, bool settled) noexcept {
  waited_ += sample.period;
  // While two readings disagree, the position of the axes is unknown, and no power is commanded.
  commanded_ &= settled;
  const bool on = commanded_ && sample.drive.enabled;
  Refusal refusal = checks_.powerRefusal(sample);
  if (refusal == Refusal::kNone) refusal = command(sample, settled);
  if (refusal == Refusal::kNone && !on) {
    if (waited_ <= config_.enable_timeout) return std::nullopt;
    refusal = !settled ? Refusal::kFeedback : commanded_ ? Refusal::kNoPower : Refusal::kPowerStays;
    if (refusal == Refusal::kPowerStays && isPreparing()) refusal = Refusal::kPreparing;
  }
  if (refusal != Refusal::kNone) commanded_ = false;
  awaited_ = false;
  return refusal;
}

/// Commands the power once the earlier power is off, which could be taken for the new, the drive is prepared and the
/// command is where the axes are.
Refusal Power::command(const CycleSample& sample, bool settled) noexcept {
  if (commanded_ || sample.drive.enabled) return Refusal::kNone;
  if (preparation_ && !preparation_begun_) {
    if (!preparation_->begin()) return Refusal::kPreparing;
    preparation_begun_ = true;
  }
  if (isPreparing() || !settled) return Refusal::kNone;
  commanded_ = !preparation_ || preparation_->state() == DrivePreparation::State::kReady;
  return commanded_ ? Refusal::kNone : Refusal::kNotPrepared;
}

}  // namespace grinder
