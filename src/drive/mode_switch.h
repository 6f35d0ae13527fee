#pragma once

#include <utility>

namespace grinder {

/// Switches hardware over to the grinder's commands and back, as ros_control's controller manager does for a
/// controller: once per change, and then waits for the result. Real-time safe if the hardware's functions are.
class ModeSwitch {
 public:
  enum class Result { kDone, kOngoing, kError };

  /// To be called in every cycle, before the command is written.
  /// @param wanted whether the hardware is to take the commands.
  /// @param hardware object with doSwitch(bool on) and Result switchResult(), polled while the hardware switches on.
  template <typename Hardware>
  void update(bool wanted, Hardware&& hardware) {
    if (!wanted) {
      // The state changes first, because the hardware may throw.
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
  /// Whether the hardware failed to switch on; it is asked again only after it has been switched off.
  bool isRefused() const noexcept { return state_ == State::kRefused; }

 private:
  enum class State { kOff, kSwitching, kOn, kRefused };
  State state_ = State::kOff;
};

}  // namespace grinder
