#include "flute_grinder/control/stop_requests.h"

namespace grinder {

std::uint32_t StopRequests::postWithReply(MachineEvent stop) noexcept {
  const std::uint32_t ticket = ticket_.load(std::memory_order_relaxed) + 1;
  ticket_.store(ticket, std::memory_order_relaxed);
  bits_.fetch_or(replyBit(stop));
  return ticket;
}

std::optional<Answer> StopRequests::reply(MachineEvent stop, std::uint32_t ticket) const noexcept {
  if (!isStop(stop)) return std::nullopt;
  const std::uint64_t word = answers_[indexOf(stop)].load(std::memory_order_acquire);
  if (word >> 32 != ticket) return std::nullopt;
  Answer answer;
  answer.event = stop;
  answer.state = static_cast<MachineState>(word >> 8 & 0xff);
  answer.refusal = static_cast<Refusal>(word & 0xff);
  return answer;
}

void StopRequests::answer(const Answer& answer) noexcept {
  const std::uint64_t ticket = ticket_.load(std::memory_order_relaxed);
  answers_[indexOf(answer.event)].store(
      ticket << 32 | static_cast<std::uint64_t>(answer.state) << 8 | static_cast<std::uint64_t>(answer.refusal),
      std::memory_order_release);
}

}  // namespace grinder
