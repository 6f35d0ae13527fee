#pragma once

#include <utility>

namespace grinder {

/// Switches hardware over to the grinder's commands and back, as ros_control's controller manager does with a
/// controller: once for every change, and then waits for the result. Real-time safe as far as the hardware's functions
/// are.
class ModeSwitch {
 public:
  enum class Result { kDone, kOngoing, kError };

  /// To be called in every cycle, before the command is written.
  /// @param wanted whether the hardware is to take the commands.
  /// @param hardware with doSwitch(bool on) and Result switchResult(), which is asked while it switches on.
  template <typename Hardware>
  void update(bool wanted, Hardware&& hardware) {
    if (!wanted) {
      // First, since the hardware may throw.
      if (std::exchange(state_, State::kOff) != State::kOff) hardware.doSwitch(false);
      return;
    }
    if (state_ == State::kOff) {
      state_ = State::kSwitching;
      hardware.doSwitch(true);
    }
    if (state_ != State::kSwitching) return;
    const Result result = hardware.switchResult();
    if (result == Result::kDone) state_ = State::kOn;
    if (result == Result::kError) state_ = State::kRefused;
  }

  bool isOn() const noexcept { return state_ == State::kOn; }
  /// The hardware has not switched on, and is not asked again until it has been switched off.
  bool isRefused() const noexcept { return state_ == State::kRefused; }

 private:
  enum class State { kOff, kSwitching, kOn, kRefused };
  State state_ = State::kOff;
};

}  // namespace grinder
