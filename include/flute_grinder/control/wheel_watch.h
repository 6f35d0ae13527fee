#pragma once

#include "flute_grinder/control/loop_requests.h"
#include "flute_grinder/control/loop_status.h"

#include <algorithm>
#include <optional>

namespace grinder {

/// Where a lift ends: first along X, then along Y.
struct LiftTarget {
  double x = 0, y = 0;  ///< [m]
};

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
    const bool is_clear = y && *y >= wheel_.clear_y - kBefore;
    seen_clear_ = is_clear ? seen_clear_ + period : 0;
    if (seen_clear_ >= kSeenClear) clear();
    if (left_by_job_ && (wheel_.y_doubted || (y && !is_clear))) wheel_.in_work = true;
  }
  /// To be called with true when Y was read where the axis cannot have been, and with false when it is trusted again.
  void doubtY(bool doubted) noexcept { wheel_.y_doubted = doubted; }
  /// To be called when a lift without a job begins.
  void beginLift(const LiftTarget& target) noexcept { last_target_ = target; }
  /// To be called when a lift without a job is complete.
  void finishLift() noexcept { clear(); }
  /// To be called when the zeros may have changed since the last lift began: without power, or when the reference
  /// is found.
  void forgetLift() noexcept { last_target_.reset(); }

  /// Target for lifting the wheel.
  /// @param x_homed,y_homed whether the axis refers to the machine's reference; otherwise only the distance of the lift
  ///        is known, and a lift that was stopped continues.
  /// @param at commanded position of the axes [m], A [rad].
  LiftTarget liftTarget(bool x_homed, bool y_homed, const Axes& at) const noexcept {
    // For an unknown job the targets are the ends of the travels. Without the reference X may read beyond its end, and
    // stays; a wheel that reads above the top is lifted by the whole travel.
    const bool to_top = !wheel_.known && at[kY] < wheel_.clear_y;
    LiftTarget target{wheel_.known ? at[kX] - wheel_.back : wheel_.clear_x,
                      to_top ? wheel_.clear_y : at[kY] + wheel_.lift};
    if (last_target_) target = *last_target_;
    if (x_homed) target.x = wheel_.clear_x;
    if (y_homed) target.y = wheel_.clear_y;
    return {wheel_.back > 0 ? std::min(at[kX], target.x) : at[kX], target.y};
  }

  /// Whether the way out of the work leads along X before the wheel may rise.
  /// @param x commanded X, relative to the machine's reference [m].
  bool backsOff(double x) const noexcept { return wheel_.back > 0 && x > wheel_.clear_x + kBefore; }
  /// Whether a motion of a single axis takes the wheel out of the work as a lift does. @param x as for backsOff() [m].
  bool isWayOut(int axis, bool upward, double x) const noexcept {
    return backsOff(x) ? axis == kX && !upward : axis == kY && upward;
  }

 private:
  void clear() noexcept {
    wheel_.in_work = false;
    wheel_.known = true;
  }

  static constexpr double kSeenClear = 0.1;  ///< time for which Y must read clear [s]
  /// How far before its target a lifted axis may rest; a tenth of the least clearance of a job [m].
  static constexpr double kBefore = 10e-6;

  Wheel wheel_;
  double seen_clear_ = 0;     ///< time for which Y has read clear [s]
  bool left_by_job_ = false;  ///< a job left the wheel where it is, and it was not moved with power since
  std::optional<LiftTarget> last_target_;
};

}  // namespace grinder
