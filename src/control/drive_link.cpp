#include "flute_grinder/control/drive_link.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <exception>

namespace grinder {

namespace {

void append(FaultText& text, std::int64_t number) noexcept {
  std::array<char, 21> digits{};
  std::to_chars(digits.begin(), digits.end() - 1, number);
  text += digits.data();
}

}  // namespace

template <typename Call>
void DriveLink::call(const char* function, const Call& call) noexcept {
  try {
    return call();
  } catch (const std::exception& error) {
    thrown_ = textOrNone(error);
  } catch (...) {
    thrown_ = "an exception that is no std::exception";
  }
  FaultText by;
  by = " (thrown by its ";
  by += function;
  by += ")";
  thrown_.endWith(by);
  has_thrown_ = true;
}

ros::Duration DriveLink::wait(Clock::time_point last) noexcept {
  constexpr std::int32_t kLongest = 3600;  // such as after a suspension of the computer [s]
  const ros::Duration nominal(config_.machine.period);
  ros::Duration period = nominal;
  bool waited = false;
  call("wait()", [&] {
    period = drive_.wait(nominal);
    waited = true;
  });
  if (waited && period >= ros::Duration() && period <= ros::Duration(kLongest, 0)) return period;
  if (waited) {
    thrown_ = "its wait() has returned ";
    append(thrown_, period.sec);
    thrown_ += " s; allowed: 0 to 3600 s";
    has_thrown_ = true;
  }
  // Its result is unused: it is the time since its last call, perhaps many cycles ago.
  drive_.Drive::wait(nominal);
  return ros::Duration().fromNSec(std::chrono::nanoseconds(Clock::now() - last).count());
}

void DriveLink::read(const DriveCycle& cycle, CycleSample& sample) noexcept {
  call("read()", [&] { drive_.read(cycle, feedback_); });
  const std::uint64_t last_feedback = sample.drive.feedback_count;
  const Axes last = sample.position;
  const double elapsed = sample.feedback_age + sample.period;
  sample.drive = feedback_.status;
  if (has_thrown_) {
    sample.drive.fault = true;
    sample.drive.fault_text = thrown_;
    has_thrown_ = false;
  }
  boundCommandsWaiting(sample.drive);
  sample.feedback_age = sample.drive.feedback_count == last_feedback ? sample.feedback_age + sample.period : 0;
  std::copy(feedback_.position.begin(), feedback_.position.end(), sample.position.data());
  std::copy(feedback_.velocity.begin(), feedback_.velocity.end(), sample.velocity.data());
  // Before the first reading the feedback still has its initial value 0.
  has_positions_ = has_positions_ || (sample.drive.feedback_count > 0 && sample.position.isFinite().all());
  // A motion without feedback is believed for no longer than feedback_timeout.
  const Axes most =
      config_.following_error + config_.machine.limits.max_velocity * std::min(elapsed, config_.feedback_timeout);
  credible_ = (sample.position - last).abs() <= most;  // false for NaN
  if (sample.feedback_age == 0) settled_ = credible_.all();
}

/// Limits the drive's count of waiting commands to its buffer: with a false count the axes would never come to rest.
void DriveLink::boundCommandsWaiting(DriveStatus& status) const noexcept {
  const std::uint32_t reported = status.commands_waiting;
  if (reported <= capabilities_.buffer) return;
  status.commands_waiting = capabilities_.buffer;
  if (status.fault) return;
  status.fault = true;
  status.fault_text = "it has reported ";
  append(status.fault_text, reported);
  status.fault_text += " commands waiting; allowed: up to ";
  append(status.fault_text, capabilities_.buffer);
}

void DriveLink::write(const DriveCycle& cycle, const DriveCommand& command) noexcept {
  if (has_positions_) call("write()", [&] { drive_.write(cycle, command); });
}

}  // namespace grinder
