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

  /// Power has come on: counts underruns and slow cycles from now on.
  void powerOn(const DriveStatus& drive) noexcept {
    underruns_at_power_on_ = drive.underruns;
    time_ = bounded_time_ = cycles_ = slow_ = 0;
  }

  /// The drive has been commanded to clear its fault.
  void reset() noexcept { was_reset_ = true; }
  /// To be called in each cycle.
  void observe(const CycleSample& sample) noexcept;

  /// Why the drive may not be powered; kNone if it may.
  Refusal powerRefusal(const CycleSample& sample) const noexcept;

  /// The fault for which the powered machine must stop, if there is one.
  /// @param moving_unbuffered whether the axes were moving and the drive's buffer had no more commands.
  std::optional<LoopFault> findFault(const CycleSample& sample, bool moving_unbuffered) const noexcept;

 private:
  double longestOnAverage() const noexcept;  ///< [s]
  bool feedbackIsFresh(const CycleSample& sample) const noexcept;
  std::optional<LoopFault> findFeedbackFault(const CycleSample& sample) const noexcept;

  const LoopConfig& config_;
  std::uint64_t underruns_at_power_on_ = 0;
  bool was_reset_ = false;  ///< since the drive reported its present fault
  // Of the cycles in the present second.
  double time_ = 0;          ///< [s]
  double bounded_time_ = 0;  ///< in which a cycle counts at most as the one from which the axes are slowed down [s]
  double cycles_ = 0;
  double slow_ = 0;  ///< average time of a cycle in the second before, if that was too long; 0 if not [s]
};

/// The first open interlock; kNone if grinding is allowed. What is not commanded counts as missing, though the wheel
/// may still be at speed. Real-time safe.
/// @param spindle, coolant commanded.
Interlock openInterlock(const DriveStatus& drive, bool spindle, bool coolant) noexcept;

}  // namespace grinder
