#pragma once

#include "flute_grinder/control/loop_requests.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace grinder {

/// Stop requests to the control loop, as bits of one word: none is refused because a queue is full, none is lost, and
/// none waits for another request. A stop posted twice before the loop takes it counts once.
class StopRequests {
 public:
  static constexpr std::array<MachineEvent, 3> kStops{MachineEvent::kHold, MachineEvent::kCancel,
                                                      MachineEvent::kDisable};

  /// The stops that the loop took in one cycle.
  class Taken {
   public:
    explicit Taken(std::uint32_t bits) noexcept : bits_(bits) {}
    bool has(MachineEvent stop) const noexcept { return bits_ & (bit(stop) | replyBit(stop)); }
    bool wantsReply(MachineEvent stop) const noexcept { return bits_ & replyBit(stop); }

   private:
    std::uint32_t bits_;
  };

  /// For any thread and for signal handlers; an event that is not a stop is ignored.
  void post(MachineEvent stop) noexcept { bits_.fetch_or(bit(stop)); }

  /// As post(), with an answer. For one thread at a time.
  /// @return a ticket for reply().
  std::uint32_t postWithReply(MachineEvent stop) noexcept;
  /// The answer to a ticket, once available. For the requesting thread.
  std::optional<Answer> reply(MachineEvent stop, std::uint32_t ticket) const noexcept;

  /// For the loop: all stops posted since the last call.
  Taken take() noexcept {
    // The exchange is the cycle's only locked instruction, and nearly every cycle finds no stop.
    return Taken(bits_.load(std::memory_order_acquire) == 0 ? 0 : bits_.exchange(0));
  }
  /// For the loop: answers a stop that requested a reply.
  void answer(const Answer& answer) noexcept;

 private:
  static constexpr std::size_t indexOf(MachineEvent stop) noexcept {
    for (std::size_t i = 0; i < kStops.size(); ++i) {
      if (kStops[i] == stop) return i;
    }
    return kStops.size();
  }
  static constexpr std::uint32_t bit(MachineEvent stop) noexcept { return isStop(stop) ? 1u << indexOf(stop) : 0; }
  static constexpr std::uint32_t replyBit(MachineEvent stop) noexcept { return bit(stop) << kStops.size(); }

  std::atomic<std::uint32_t> bits_{0};
  std::atomic<std::uint32_t> ticket_{0};                             ///< the latest ticket
  std::array<std::atomic<std::uint64_t>, kStops.size()> answers_{};  ///< ticket, state and refusal in one word
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "signal handlers post stops");
};

}  // namespace grinder
