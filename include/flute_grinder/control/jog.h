#pragma once

#include "flute_grinder/base/axes.h"

#include <cstdint>
#include <limits>

namespace grinder {

/// A request to move an axis: by hand, or as a step of a series.
struct JogRequest {
  int axis = kX;
  bool continuous = false;
  double distance = 0;  ///< distance of a step, signed [m], A [rad]
  double velocity = 0;  ///< speed of a step; signed velocity of a continuous jog, 0 stops it [m/s], A [rad/s]
  /// For a step of a series, LoopStatus::stops when the step was decided on: any stop since then refuses the step. 0 to
  /// skip this check.
  std::uint64_t stops = 0;
  bool to_touch = false;    ///< the jog is refused if the measuring probe already touches
  bool for_client = false;  ///< the step stops if RequestBox::keepAlive() is not called for jog_timeout
};

/// Times the silence of a client that must keep sending messages. Counts the loop's cycles, so that no other thread can
/// keep an axis moving. Real-time safe.
class SilenceTimer {
 public:
  /// @param timeout longest allowed time between messages [s].
  explicit SilenceTimer(double timeout) noexcept : timeout_(timeout) {}

  /// To be called in every cycle. @param period since the previous cycle [s].
  void wait(double period) noexcept { age_ += period; }
  /// To be called when a message has come.
  void restart() noexcept {
    age_ = 0;
    forgiven_ = false;
  }
  /// To be called after a stall of the whole process, when a message may still wait to be read: restarts the count,
  /// once per message.
  void forgive() noexcept {
    if (!forgiven_ && !expired()) age_ = 0;
    forgiven_ = true;
  }

  bool expired() const noexcept { return !(age_ <= timeout_); }

 private:
  double timeout_;
  double age_ = std::numeric_limits<double>::infinity();  ///< time since the last message [s]
  bool forgiven_ = false;
};

/// The dead man's switch of a continuous jog. It belongs to the axis of the first message that moves, until a message
/// that stops releases it. Once the jog was stopped or refused, or its messages have failed to come, a switch that is
/// still pressed moves nothing until it is released. Silence does not release it, because a stalled client does not
/// know whether its button is still pressed. Real-time safe.
class DeadMansSwitch {
 public:
  enum class State : std::uint8_t {
    kReleased,
    kPressed,   ///< the axis may move, in this state alone
    kTimedOut,  ///< no message came in time, and no message that stops has come since
    kStopped,   ///< the jog was stopped or refused, and no message that stops has come since
  };

  /// @param timeout longest allowed time between messages [s].
  explicit DeadMansSwitch(double timeout) noexcept : silence_(timeout) {}

  /// To be called in every cycle. @param period since the previous cycle [s].
  void wait(double period) noexcept {
    silence_.wait(period);
    if (state_ == State::kPressed && silence_.expired()) state_ = State::kTimedOut;
  }
  /// To be called after a stall of the whole process, see SilenceTimer.
  void forgive() noexcept { silence_.forgive(); }
  /// To be called when a message that moves has come. @return whether it is for the switch's axis; if not, nothing
  /// changes.
  bool press(int axis) noexcept {
    if (state_ == State::kReleased) {
      state_ = State::kPressed;
      axis_ = axis;
    }
    if (axis != axis_) return false;
    silence_.restart();
    return true;
  }
  /// To be called when a message that stops has come.
  void release() noexcept { state_ = State::kReleased; }
  /// To be called when the jog was stopped or refused.
  void block() noexcept {
    if (state_ == State::kPressed) state_ = State::kStopped;
  }

  State state() const noexcept { return state_; }

 private:
  SilenceTimer silence_;
  State state_ = State::kReleased;
  int axis_ = kX;
};

}  // namespace grinder
