#pragma once

#include "flute_grinder/control/drive_checks.h"
#include "flute_grinder/control/drive_preparation.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>

namespace grinder {

/// The power of the drive: commands it, waits for it, and notices power that stays, and powerOff() called by the
/// watchdog. Real-time safe except for constructor and destructor.
class Power {
 public:
  /// @param drive, config and checks must outlive this object. @param prepares whether the drive has a prepare().
  Power(Drive& drive, bool prepares, const LoopConfig& config, const DriveChecks& checks)
      : config_(config), checks_(checks) {
    if (prepares) preparation_.emplace(drive);
  }

  // For any thread; see ControlLoop.
  void beginPowerOff() noexcept { call_ = Call::kInProgress; }
  void endPowerOff() noexcept { call_ = Call::kReturned; }
  bool isPoweringOff() const noexcept { return call_ == Call::kInProgress; }
  bool isPreparing() const noexcept {
    return preparation_ && preparation_->state() == DrivePreparation::State::kPreparing;
  }

  // For the loop:
  /// To be called after each reading: tells the sample whether the power stays. Reports a drive fault if the watchdog
  /// has called powerOff(), whatever the drive says, until the call has returned.
  void observe(CycleSample& sample) noexcept;
  /// Whether the drive hung until this cycle.
  bool hasHung() const noexcept { return has_hung_; }

  /// Begins to switch the power on, unless it is on. @return why not; kNone if it begins.
  Refusal begin(const CycleSample& sample) noexcept;
  /// Whether the power is being switched on.
  bool isAwaited() const noexcept { return awaited_; }
  /// To be called in every cycle in which the power is awaited: commands it. @param settled see DriveLink::isSettled().
  /// @return how the wait has ended, if it has; kNone if the power is on.
  std::optional<Refusal> await(const CycleSample& sample, bool settled) noexcept;
  /// Gives up the power awaited. @return whether there was any.
  bool withdraw() noexcept { return std::exchange(awaited_, false); }
  /// Commands the power off.
  void off() noexcept { commanded_ = off_at_rest_ = false; }
  /// Has the power go off once the axes are at rest: then the loop calls off().
  void offAtRest() noexcept { off_at_rest_ = true; }

  bool goesOffAtRest() const noexcept { return off_at_rest_; }
  bool commanded() const noexcept { return commanded_; }
  /// Why the drive is not prepared, for Refusal::kNotPrepared.
  const FaultText& whyNotPrepared() const noexcept { return preparation_->why(); }

 private:
  /// Progress of the drive's powerOff() since the loop last looked.
  enum class Call : std::uint8_t { kNone, kInProgress, kReturned };

  Refusal command(const CycleSample& sample, bool settled) noexcept;

  const LoopConfig& config_;
  const DriveChecks& checks_;
  std::optional<DrivePreparation> preparation_;  ///< present if the drive has a prepare()
  std::atomic<Call> call_{Call::kNone};
  bool has_hung_ = false;
  bool commanded_ = false;
  bool off_at_rest_ = false;
  bool awaited_ = false;
  bool preparation_begun_ = false;  ///< prepare() was called for the power awaited
  double waited_ = 0;               ///< time waited for power [s]
  double unwanted_ = 0;             ///< time for which the drive has reported power that is commanded off [s]
};

}  // namespace grinder
