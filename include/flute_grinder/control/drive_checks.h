#pragma once

#include "flute_grinder/control/cycle_sample.h"
#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/control/loop_requests.h"

#include <cstdint>
#include <optional>

namespace grinder {

/// Checks the drive's reports in a cycle against the limits and timeouts. Real-time safe.
class DriveChecks {
 public:
  /// @param config must outlive this object.
  explicit DriveChecks(const LoopConfig& config) noexcept : config_(config) {}

  /// To be called when power has come on: starts to count underruns and slow cycles.
  void powerOn(const DriveStatus& drive) noexcept {
    underruns_at_power_on_ = drive.underruns;
    time_ = bounded_time_ = cycles_ = slow_ = 0;
  }

  /// To be called when the drive has been commanded to clear its fault.
  void reset() noexcept { was_reset_ = true; }
  /// To be called in each cycle.
  void observe(const CycleSample& sample) noexcept;

  /// Why the drive may not be powered; kNone if it may.
  Refusal powerRefusal(const CycleSample& sample) const noexcept;

  /// The fault for which the powered machine must stop, if there is one.
  /// @param moving_unbuffered whether the axes were moving and the drive's buffer had no more commands.
  std::optional<LoopFault> findFault(const CycleSample& sample, bool moving_unbuffered) const noexcept;

 private:
  double longestOnAverage() const noexcept;  ///< longest allowed average cycle [s]
  bool feedbackIsFresh(const CycleSample& sample) const noexcept;
  std::optional<LoopFault> findFeedbackFault(const CycleSample& sample) const noexcept;

  const LoopConfig& config_;
  std::uint64_t underruns_at_power_on_ = 0;
  bool was_reset_ = false;  ///< a reset was commanded since the drive reported its present fault
  // Sums over the cycles of the present second.
  double time_ = 0;          ///< sum of the cycles' periods [s]
  double bounded_time_ = 0;  ///< same sum, with each cycle capped at the period from which the axes are slowed down [s]
  double cycles_ = 0;
  double slow_ = 0;  ///< average cycle of the previous second if it was too long, else 0 [s]
};

/// The first open interlock; kNone if grinding is allowed. A spindle or coolant that is not commanded counts as
/// missing, even if the wheel is still at speed. Real-time safe.
/// @param spindle, coolant whether each is commanded.
Interlock openInterlock(const DriveStatus& drive, bool spindle, bool coolant) noexcept;

}  // namespace grinder
