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

/// The dead man's switch of a continuous jog, or of a series, whose messages must come again and again. Once the jog
/// was stopped or refused, a switch that is still pressed moves nothing: it must first be released, by a message that
/// stops or by none until the time-out. Counts the cycles, so that no other thread can keep an axis moving.
/// Real-time safe.
class DeadMansSwitch {
 public:
  /// @param timeout longest allowed time between messages [s].
  explicit DeadMansSwitch(double timeout) noexcept : timeout_(timeout) {}

  /// To be called in every cycle. @param period since the previous cycle [s].
  void wait(double period) noexcept { age_ += period; }
  /// A message has come. @return whether it may move an axis.
  bool press() noexcept {
    if (released()) blocked_ = false;
    age_ = 0;
    return !blocked_;
  }
  /// A message that stops has come.
  void release() noexcept {
    age_ = std::numeric_limits<double>::infinity();
    blocked_ = false;
  }
  /// The jog was stopped or refused.
  void block() noexcept { blocked_ = true; }

  bool released() const noexcept { return !(age_ <= timeout_); }

 private:
  double timeout_;
  double age_ = std::numeric_limits<double>::infinity();  ///< of the last message [s]
  bool blocked_ = false;
};

}  // namespace grinder
