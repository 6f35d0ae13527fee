#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/control/cycle_sample.h"
#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/drive/drive.h"

#include <chrono>

namespace grinder {

/// The control loop's calls of the drive. An exception, a failed wait or a false count is a drive fault of the next
/// reading. Real-time safe except for the constructor.
class DriveLink {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param drive initialised. @param config and drive must outlive this object.
  DriveLink(Drive& drive, const LoopConfig& config)
      : drive_(drive), capabilities_(drive.capabilities()), config_(config) {}

  /// Waits for the next cycle. If the drive's own wait fails, the monotonic clock is used.
  /// @param last start of the last cycle. @return time since then.
  ros::Duration wait(Clock::time_point last) noexcept;
  /// Reads the drive's status and the axes into the sample, whose period must be set.
  void read(const DriveCycle& cycle, CycleSample& sample) noexcept;
  /// Writes a command; before the first positions there is none to write.
  void write(const DriveCycle& cycle, const DriveCommand& command) noexcept;

  const DriveCapabilities& capabilities() const noexcept { return capabilities_; }
  /// Whether all positions have been finite at least once.
  bool hasPositions() const noexcept { return has_positions_; }
  /// Whether an axis can have moved to its last reading. If not, the axis has a new reference or the reading is wrong;
  /// the next reading shows which.
  bool isCredible(int axis) const noexcept { return credible_[axis]; }
  /// Whether the last two readings agree: every axis can have moved from one to the other.
  bool isSettled() const noexcept { return settled_; }

 private:
  template <typename Call>
  void call(const char* function, const Call& call) noexcept;
  void boundCommandsWaiting(DriveStatus& status) const noexcept;

  Drive& drive_;
  const DriveCapabilities capabilities_;
  const LoopConfig& config_;
  FaultText thrown_;         ///< text of the drive's exception, since the last read()
  bool has_thrown_ = false;  ///< the drive has thrown since the last read()
  bool has_positions_ = false;
  bool settled_ = false;
  Eigen::Array<bool, kAxisCount, 1> credible_ = decltype(credible_)::Constant(false);
  DriveFeedback feedback_;
};

}  // namespace grinder
