#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

/// @file
/// Inputs from and outputs to other programs, for hardware that lacks them.
namespace grinder {

/// A Boolean signal of the machine: constant, or received repeatedly from another program.
class SignalInput {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param source "always", "never" or the topic's name.
  /// @param safe value while the signal is unknown.
  /// @param timeout time after which a received value expires; 0 for never [s].
  SignalInput(const std::string& source, bool safe, double timeout);

  /// The topic from which the signal is received; empty if it is constant.
  const std::string& topic() const { return topic_; }
  /// Takes a message's value. Thread safe.
  void receive(bool value, Clock::time_point now) noexcept;
  /// The signal's value; the safe value before the first message and after the timeout. Thread safe, real-time safe.
  bool at(Clock::time_point now) const noexcept;

 private:
  std::string topic_;
  bool safe_;
  Clock::duration timeout_;
  std::atomic<bool> value_;
  std::atomic<Clock::rep> received_{0};  ///< time of the last message; 0 for none
};

/// Switches a function of another program on and off, in a thread of its own, because that may take long or hang. The
/// latest command wins: a withdrawn command is given up, and never sent again. Begins with off, because an earlier
/// program may have left the function on.
class SwitchOutput {
 public:
  /// Sends a command.
  /// @param still_wanted to be polled while the other program does not answer; once it is false, give up.
  /// @return whether the command was taken; an exception counts as false.
  using Send = std::function<bool(bool on, const std::function<bool()>& still_wanted)>;

  /// @param send called in that thread, and again after a while until the command is taken.
  explicit SwitchOutput(Send send);
  /// Sends the last command, within half a second at most.
  ~SwitchOutput();

  // Thread safe and real-time safe.
  void set(bool on) noexcept { wanted_ = on; }
  bool isOn() const noexcept { return wanted_ && passed_ == Passed::kOn; }
  bool isOff() const noexcept { return !wanted_ && passed_ == Passed::kOff; }
  /// Whether the command has been sent, but not taken so far.
  bool hasFailed() const noexcept { return passed_ == (wanted_ ? Passed::kOnFailed : Passed::kOffFailed); }

 private:
  enum class Passed : std::uint8_t { kNothing, kOff, kOn, kOffFailed, kOnFailed };
  void run();

  const Send send_;
  std::atomic<bool> wanted_{false};
  std::atomic<Passed> passed_{Passed::kNothing};
  std::atomic<SignalInput::Clock::rep> ends_at_{0};  ///< time to give up; 0 while this object is in use
  std::thread thread_;
};

/// Asks another program to do something once, in a thread of its own.
class TriggerOutput {
 public:
  /// As SwitchOutput::Send, for a request that cannot be switched off.
  using Send = std::function<bool(const std::function<bool()>& still_wanted)>;

  explicit TriggerOutput(Send send);
  ~TriggerOutput();

  // Thread safe and real-time safe.
  void fire() noexcept { ++fired_; }
  void giveUp() noexcept { given_up_ = fired_.load(); }  ///< withdraws all requests fired so far
  bool isBusy() const noexcept { return done_ != fired_; }
  bool hasFailed() const noexcept { return failed_; }  ///< whether the last request failed

 private:
  void run();

  const Send send_;
  std::atomic<std::uint32_t> fired_{0}, given_up_{0}, done_{0};
  std::atomic<bool> failed_{false}, ends_{false};
  std::thread thread_;
};

}  // namespace grinder
