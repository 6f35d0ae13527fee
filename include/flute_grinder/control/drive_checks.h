#pragma once

#include "flute_grinder/control/cycle_record.h"
#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/control/loop_requests.h"

#include <cstdint>
#include <optional>

namespace flute_grinder {

/// Checks what the drive reports in a cycle against the limits and timeouts. Real-time safe.
class DriveChecks {
 public:
  /// @param config must outlive this object.
  explicit DriveChecks(const LoopConfig& config) noexcept : config_(config) {}

  /// Underruns count from here on: the power has come.
  void powerOn(const DriveStatus& drive) noexcept { underruns_at_power_on_ = drive.underruns; }

  /// Why the drive may not be powered; kNone if it may.
  Refusal powerRefusal(const CycleRecord& record) const noexcept;

  /// The fault, if there is one, for which the powered machine must stop.
  /// @param moving_unbuffered whether the axes were moving without further commands in the drive's buffer.
  std::optional<LoopFault> findFault(const CycleRecord& record, bool moving_unbuffered) const noexcept;

 private:
  bool feedbackIsFresh(const CycleRecord& record) const noexcept;
  std::optional<LoopFault> findFeedbackFault(const CycleRecord& record) const noexcept;

  const LoopConfig& config_;
  std::uint64_t underruns_at_power_on_ = 0;
};

/// The first interlock that is open; kNone if the wheel may be at the work. Real-time safe.
Interlock openInterlock(const DriveStatus& drive) noexcept;

}  // namespace flute_grinder
