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
  /// @return its value; the safe one before the first message and after the timeout. Thread safe, real-time safe.
  bool at(Clock::time_point now) const noexcept;

 private:
  std::string topic_;
  bool safe_;
  Clock::duration timeout_;
  std::atomic<bool> value_;
  std::atomic<Clock::rep> received_{0};  ///< when; 0 for never
};

/// Switches something of another program on and off, in a thread of its own, because that may take long or hang. The
/// latest command wins: one that was withdrawn is given up, and never sent again. Begins with off, since nothing is
/// known of what a program before has left on.
class SwitchOutput {
 public:
  /// @param still_wanted to be asked again and again while the other program does not answer; once false, give up.
  /// @return whether it was taken. What it throws counts as not.
  using Send = std::function<bool(bool on, const std::function<bool()>& still_wanted)>;

  /// @param send called in that thread, and again after a while as long as it is not taken.
  explicit SwitchOutput(Send send);
  /// Passes the last command on, if that takes no longer than half a second.
  ~SwitchOutput();

  // Thread safe and real-time safe.
  void set(bool on) noexcept { wanted_ = on; }
  bool isOn() const noexcept { return wanted_ && passed_ == Passed::kOn; }
  bool isOff() const noexcept { return !wanted_ && passed_ == Passed::kOff; }
  /// The command has been sent, and was not taken so far.
  bool hasFailed() const noexcept { return passed_ == (wanted_ ? Passed::kOnFailed : Passed::kOffFailed); }

 private:
  enum class Passed : std::uint8_t { kNothing, kOff, kOn, kOffFailed, kOnFailed };
  void run();

  const Send send_;
  std::atomic<bool> wanted_{false};
  std::atomic<Passed> passed_{Passed::kNothing};
  std::atomic<SignalInput::Clock::rep> ends_at_{0};  ///< when to give up; 0: it does not end
  std::thread thread_;
};

/// Asks another program to do something once, in a thread of its own.
class TriggerOutput {
 public:
  /// As SwitchOutput::Send, without an off.
  using Send = std::function<bool(const std::function<bool()>& still_wanted)>;

  explicit TriggerOutput(Send send);
  ~TriggerOutput();

  // Thread safe and real-time safe.
  void fire() noexcept { ++fired_; }
  void giveUp() noexcept { given_up_ = fired_.load(); }  ///< what has been fired so far
  bool isBusy() const noexcept { return done_ != fired_; }
  bool hasFailed() const noexcept { return failed_; }  ///< the last one

 private:
  void run();

  const Send send_;
  std::atomic<std::uint32_t> fired_{0}, given_up_{0}, done_{0};
  std::atomic<bool> failed_{false}, ends_{false};
  std::thread thread_;
};

}  // namespace grinder
