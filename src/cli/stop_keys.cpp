#include "cli/stop_keys.h"

#include "cli/interrupt.h"
#include "cli/waiting.h"

#include <utility>

namespace grinder {

StopKeys::~StopKeys() {
  ended_ = true;
  if (thread_.joinable()) thread_.join();
}

void StopKeys::start(std::function<void()> on_interrupt) {
  thread_ = std::thread([this, on_interrupt = std::move(on_interrupt)] { run(on_interrupt); });
}

void StopKeys::run(const std::function<void()>& on_interrupt) const {
  int interrupts_seen = 0, holds_seen = 0;
  bool hold_pending = false;
  while (!ended_) {
    if (const int count = interrupts(); count != interrupts_seen) {
      interrupts_seen = count;
      on_interrupt();
    }
    const bool pressed = holds() != holds_seen;
    const bool job = inJob(*client_.states().newest());
    if (pressed || (hold_pending && job)) {
      client_.stopNow(MachineEvent::kHold);
      // During planning there is no job to hold yet: the hold is repeated once there is one, before it moves.
      hold_pending = !job;
    }
    if (pressed) holds_seen = holds();
    ros::WallDuration(0.002).sleep();
  }
}

}  // namespace grinder
