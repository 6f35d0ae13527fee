#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

/// @file
/// What a drive gets from and passes on to other programs, beside its own hardware.
namespace grinder {

/// A yes or no of the machine: stated once and for all, or received from another program again and again.
class SignalInput {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param source "always", "never" or the topic's name.
  /// @param safe its value as long as nothing is known.
  /// @param timeout after which what was received is no longer known; 0 for never [s].
  SignalInput(const std::string& source, bool safe, double timeout);

  /// The topic from which it is received; empty if it is stated.
  const std::string& topic() const { return topic_; }
  /// Thread safe.
  void receive(bool value, Clock::time_point now) noexcept;
  /// Thread safe and real-time safe.
  bool at(Clock::time_point now) const noexcept;

 private:
  std::string topic_;
  bool safe_;
  Clock::duration timeout_;
  std::atomic<bool> value_;
  std::atomic<Clock::rep> received_{0};  ///< when; 0 for never
};

/// Passes an on or off to another program, in a thread of its own, because that may take long or hang.
class CommandOutput {
 public:
  /// @param send called in that thread, and again after a while if it returns false: the other program has refused or
  ///     does not answer. May outlive this object by as long as it hangs, and must own what it uses.
  explicit CommandOutput(std::function<bool(bool on)> send);
  ~CommandOutput();

  // Thread safe and real-time safe.
  void set(bool on) noexcept;
  bool isOn() const noexcept { return is(true); }             ///< on was set, and has been passed on
  bool isOff() const noexcept { return is(false); }           ///< off was set, and has been passed on
  bool hasFailed() const noexcept { return state_->failed; }  ///< and is tried again

 private:
  /// Even numbers are off, odd ones on; each counts on from the one before, so that none is left out.
  struct State {
    std::atomic<std::uint32_t> asked{0}, passed{0};
    std::atomic<bool> failed{false};  ///< the one after `passed`
    std::atomic<bool> ends{false}, has_ended{false};
  };
  static void run(State& state, const std::function<bool(bool)>& send);
  bool is(bool on) const noexcept;

  std::shared_ptr<State> state_;
  std::thread thread_;
};

}  // namespace grinder
