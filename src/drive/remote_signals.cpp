#include "drive/remote_signals.h"

#include <utility>

namespace grinder {

namespace {

constexpr std::chrono::milliseconds kLook{1};    ///< the control loop wakes no thread
constexpr std::chrono::milliseconds kRetry{50};  ///< after a failure
constexpr std::chrono::milliseconds kEnd{500};   ///< for a call that hangs, when the program ends

}  // namespace

SignalInput::SignalInput(const std::string& source, bool safe, double timeout)
    : topic_(source == "always" || source == "never" ? "" : source),
      safe_(safe),
      timeout_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout))),
      value_(source == "always") {}

void SignalInput::receive(bool value, Clock::time_point now) noexcept {
  value_ = value;
  received_ = now.time_since_epoch().count();
}

bool SignalInput::at(Clock::time_point now) const noexcept {
  if (topic_.empty()) return value_;
  const Clock::rep received = received_;
  const bool old = timeout_ > Clock::duration(0) && now.time_since_epoch() - Clock::duration(received) > timeout_;
  return received == 0 || old ? safe_ : value_.load();
}

CommandOutput::CommandOutput(std::function<bool(bool on)> send)
    : state_(std::make_shared<State>()), thread_([state = state_, send = std::move(send)] { run(*state, send); }) {}

CommandOutput::~CommandOutput() {
  state_->ends = true;
  const auto deadline = std::chrono::steady_clock::now() + kEnd;
  while (!state_->has_ended && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(kLook);
  if (state_->has_ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void CommandOutput::set(bool on) noexcept {
  std::uint32_t asked = state_->asked;
  while ((asked % 2 == 1) != on && !state_->asked.compare_exchange_weak(asked, asked + 1)) {
  }
}

bool CommandOutput::is(bool on) const noexcept {
  const std::uint32_t asked = state_->asked;
  return (asked % 2 == 1) == on && state_->passed == asked;
}

void CommandOutput::run(State& state, const std::function<bool(bool)>& send) {
  // What was asked for last is still passed on at the end.
  while (!state.ends || state.asked != state.passed) {
    if (state.asked == state.passed) {
      std::this_thread::sleep_for(kLook);
      continue;
    }
    const std::uint32_t next = state.passed + 1;
    const bool done = send(next % 2 == 1);
    // What has failed is tried again, unless its contrary has been asked for.
    if (done || state.asked != next) state.passed = next;
    state.failed = !done;
    if (done) continue;
    if (state.ends) break;
    std::this_thread::sleep_for(kRetry);
  }
  state.has_ended = true;
}

}  // namespace grinder
