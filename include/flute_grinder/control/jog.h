#pragma once

#include "flute_grinder/job/axes.h"

#include <cstdint>
#include <limits>

namespace grinder {

/// A request to move an axis: by hand, or as a step of a series.
struct JogRequest {
  int axis = kX;
  bool continuous = false;
  double distance = 0;  ///< of a step, signed [m], A [rad]
  double velocity = 0;  ///< of a step, its speed; of a continuous jog, signed, and 0 stops it [m/s], A [rad/s]
  /// LoopStatus::stops when this step was decided on, for a step of a series: a stop since then refuses it. 0 if no
  /// stop does.
  std::uint64_t stops = 0;
  bool to_touch = false;    ///< refused if the measuring probe touches already
  bool for_client = false;  ///< a step that ends where RequestBox::keepAlive() has not been called for jog_timeout
};

/// Counts how long a client is silent, whose messages must come again and again. Counts the cycles, so that no other
/// thread can keep an axis moving. Real-time safe.
class SilenceTimer {
 public:
  /// @param timeout longest allowed time between messages [s].
  explicit SilenceTimer(double timeout) noexcept : timeout_(timeout) {}

  /// To be called in every cycle. @param period since the previous cycle [s].
  void wait(double period) noexcept { age_ += period; }
  /// A message has come.
  void restart() noexcept {
    age_ = 0;
    forgiven_ = false;
  }
  /// The whole process was stalled, so that a message may still wait to be read: once, until the next one, the count
  /// begins anew.
  void forgive() noexcept {
    if (!forgiven_ && !expired()) age_ = 0;
    forgiven_ = true;
  }

  bool expired() const noexcept { return !(age_ <= timeout_); }

 private:
  double timeout_;
  double age_ = std::numeric_limits<double>::infinity();  ///< of the last message [s]
  bool forgiven_ = false;
};

/// The dead man's switch of a continuous jog. Once the jog was stopped or refused, or its messages have failed to come,
/// a switch that is still pressed moves nothing: only a message that stops releases it. A client that was stalled does
/// not know whether its button is still pressed, so its silence releases nothing. From the first message that moves to
/// the release it is the switch of that message's axis. Real-time safe.
class DeadMansSwitch {
 public:
  enum class State : std::uint8_t {
    kReleased,
    kPressed,   ///< the only one in which the axis may move
    kTimedOut,  ///< no message came in time, and none that stops since
    kStopped,   ///< the jog was stopped or refused, and no message that stops came since
  };

  /// @param timeout longest allowed time between messages [s].
  explicit DeadMansSwitch(double timeout) noexcept : silence_(timeout) {}

  /// To be called in every cycle. @param period since the previous cycle [s].
  void wait(double period) noexcept {
    silence_.wait(period);
    if (state_ == State::kPressed && silence_.expired()) state_ = State::kTimedOut;
  }
  /// The whole process was stalled, see SilenceTimer.
  void forgive() noexcept { silence_.forgive(); }
  /// A message that moves has come. @return whether it is for the switch's axis; one for another axis changes nothing.
  bool press(int axis) noexcept {
    if (state_ == State::kReleased) {
      state_ = State::kPressed;
      axis_ = axis;
    }
    if (axis != axis_) return false;
    silence_.restart();
    return true;
  }
  /// A message that stops has come.
  void release() noexcept { state_ = State::kReleased; }
  /// The jog was stopped or refused.
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
