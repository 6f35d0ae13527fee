#pragma once

#include "flute_grinder/control/loop_requests.h"
#include "flute_grinder/control/loop_status.h"

#include <optional>

namespace grinder {

/// Tracks whether the wheel is in the workpiece. Real-time safe.
class WheelWatch {
 public:
  /// @param wheel state of the wheel when the previous run of the program ended.
  explicit WheelWatch(const Wheel& wheel) noexcept : wheel_(wheel) {}

  const Wheel& wheel() const noexcept { return wheel_; }
  /// Why only a lift may move the wheel; kNone if any motion may.
  Refusal refusal() const noexcept {
    if (!wheel_.in_work) return Refusal::kNone;
    return wheel_.known ? Refusal::kInWork : Refusal::kMayBeInWork;
  }

  /// To be called when a job starts.
  void startJob(const Wheel& wheel) noexcept {
    wheel_ = wheel;
    left_by_job_ = false;
  }
  /// To be called when a job has commanded the axes to this Y [m].
  void followJob(double y) noexcept {
    wheel_.in_work = y < wheel_.clear_y;
    seen_clear_ = 0;
    left_by_job_ = true;
  }
  /// To be called in every cycle in which no job moves the axes, because the drive or an operator may move the wheel
  /// clear of the workpiece. The wheel counts as clear only after readings for kSeenClear, because a single reading may
  /// be wrong. A wheel that a job has left without power may also come to rest in the workpiece.
  /// @param y position relative to the machine's reference, if the reference is known [m].
  /// @param powered whether the axes have power.
  /// @param period of the control loop [s].
  void observePosition(const std::optional<double>& y, bool powered, double period) noexcept {
    left_by_job_ = left_by_job_ && !powered;
    const bool is_clear = y && *y >= wheel_.clear_y - kBelow;
    seen_clear_ = is_clear ? seen_clear_ + period : 0;
    if (seen_clear_ >= kSeenClear) clear();
    if (left_by_job_ && (wheel_.y_doubted || (y && !is_clear))) wheel_.in_work = true;
  }
  /// To be called with true when Y was read where the axis cannot have been, and with false when it is trusted again.
  void doubtY(bool doubted) noexcept { wheel_.y_doubted = doubted; }
  /// To be called when a lift without a job begins.
  /// @param target Y at the end of the lift, see liftTarget() [m].
  void beginLift(double target) noexcept { last_target_ = target; }
  /// To be called when a lift without a job is complete.
  void finishLift() noexcept { clear(); }
  /// To be called when the zero of Y may have changed since the last lift began: without power, or when the reference
  /// is found.
  void forgetLift() noexcept { last_target_.reset(); }

  /// Target Y for lifting the wheel [m].
  /// @param homed whether Y refers to the machine's reference; otherwise only the distance of the lift is known, and a
  ///        lift that was stopped continues.
  /// @param y current Y of the wheel [m].
  double liftTarget(bool homed, double y) const noexcept {
    // For an unknown job the target is the top of the travel, unless the wheel is already above it.
    const bool to_top = !wheel_.known && y < wheel_.clear_y;
    return homed ? wheel_.clear_y : last_target_.value_or(to_top ? wheel_.clear_y : y + wheel_.lift);
  }

 private:
  void clear() noexcept {
    wheel_.in_work = false;
    wheel_.known = true;
  }

  static constexpr double kSeenClear = 0.1;  ///< time for which Y must read clear [s]
  /// How far below its target a lifted axis may rest; a tenth of the least clearance of a job [m].
  static constexpr double kBelow = 10e-6;

  Wheel wheel_;
  double seen_clear_ = 0;     ///< time for which Y has read clear [s]
  bool left_by_job_ = false;  ///< a job left the wheel where it is, and it was not moved with power since
  std::optional<double> last_target_;
};

}  // namespace grinder
