#include "drive/remote_signals.h"

#include <exception>
#include <utility>

namespace grinder {

namespace {

constexpr std::chrono::milliseconds kLook{1};    ///< polling interval; the control loop wakes no thread
constexpr std::chrono::milliseconds kRetry{50};  ///< delay after a failure
constexpr std::chrono::milliseconds kEnd{500};   ///< time for the last command when the program ends

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

SwitchOutput::SwitchOutput(Send send) : send_(std::move(send)), thread_([this] { run(); }) {}

SwitchOutput::~SwitchOutput() {
  ends_at_ = (SignalInput::Clock::now() + kEnd).time_since_epoch().count();
  thread_.join();
}

void SwitchOutput::run() {
  const auto ends = [this] {
    const SignalInput::Clock::rep at = ends_at_;
    return at != 0 && SignalInput::Clock::now().time_since_epoch().count() > at;
  };
  while (!ends()) {
    const bool on = wanted_;
    if (passed_ == (on ? Passed::kOn : Passed::kOff)) {
      if (ends_at_ != 0) return;
      std::this_thread::sleep_for(kLook);
      continue;
    }
    bool taken = false;
    try {
      taken = send_(on, [&] { return wanted_ == on && !ends(); });
    } catch (const std::exception&) {  // a wrong name or type, already logged
    }
    if (taken) {
      passed_ = on ? Passed::kOn : Passed::kOff;
      continue;
    }
    passed_ = on ? Passed::kOnFailed : Passed::kOffFailed;
    for (auto slept = kLook * 0; slept < kRetry && wanted_ == on; slept += kLook) std::this_thread::sleep_for(kLook);
  }
}

TriggerOutput::TriggerOutput(Send send) : send_(std::move(send)), thread_([this] { run(); }) {}

TriggerOutput::~TriggerOutput() {
  ends_ = true;
  thread_.join();
}

void TriggerOutput::run() {
  while (!ends_) {
    const std::uint32_t number = fired_;
    if (done_ == number) {
      std::this_thread::sleep_for(kLook);
      continue;
    }
    bool taken = false;
    try {
      taken = send_([&] { return given_up_ != number && !ends_; });
    } catch (const std::exception&) {  // a wrong name or type, already logged
    }
    failed_ = !taken;
    done_ = number;
  }
}

}  // namespace grinder
