#pragma once

#include "flute_grinder/core/loop_fault.h"
#include "flute_grinder/core/machine_state.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

namespace flute_grinder {

/// Whether a request was carried out, and if not, why.
struct RequestReply {
  bool accepted = false;
  std::string text;      ///< why not
  bool answered = true;  ///< false if the loop has said nothing, and may yet take the request up
};

/// Why a request is not carried out.
enum class Refusal : std::uint8_t {
  kNone,
  kState,
  kEmergencyStop,
  kDriveFault,
  kInterlock,
  kNoPower,
  kMoved,
  kFeedback,
  kWithdrawn,   ///< an enable that a disable overtook
  kInWork,      ///< the wheel
  kNotInWork,   ///< the wheel
  kLiftTooFar,  ///< for the axis
};

/// What the loop says to a request; plain data, put in words outside of it.
struct Answer {
  MachineEvent event = MachineEvent::kEnable;
  MachineState state = MachineState::kDisabled;  ///< in which it was refused
  Refusal refusal = Refusal::kNone;
  Interlock interlock = Interlock::kNone;  ///< of kInterlock
  double value = 0;                        ///< of kLiftTooFar: Y that the lift would lead to [m]
  double limit = 0;                        ///< of kLiftTooFar: the axis' limit [m]

  RequestReply reply() const;
};

/// One question at a time from one thread to the loop, and its answer. No side ever waits for the other.
template <typename Question>
class RequestSlot {
 public:
  /// For the asking thread.
  /// @return false while the question before is not answered; an answer that nobody took is dropped.
  bool post(const Question& question) noexcept {
    const Stage stage = stage_.load(std::memory_order_acquire);
    if (stage == Stage::kPosted || stage == Stage::kTaken) return false;
    question_ = question;
    stage_.store(Stage::kPosted, std::memory_order_release);
    return true;
  }
  /// For the asking thread: the answer, once.
  std::optional<Answer> reply() noexcept {
    if (stage_.load(std::memory_order_acquire) != Stage::kAnswered) return std::nullopt;
    const Answer answer = answer_;
    stage_.store(Stage::kFree, std::memory_order_relaxed);
    return answer;
  }

  /// For the loop: a question that was posted, once.
  std::optional<Question> take() noexcept {
    if (stage_.load(std::memory_order_acquire) != Stage::kPosted) return std::nullopt;
    stage_.store(Stage::kTaken, std::memory_order_relaxed);
    return question_;
  }
  /// For the loop: answers what it took, then or later.
  void answer(const Answer& answer) noexcept {
    answer_ = answer;
    stage_.store(Stage::kAnswered, std::memory_order_release);
  }

 private:
  enum class Stage : std::uint8_t { kFree, kPosted, kTaken, kAnswered };

  std::atomic<Stage> stage_{Stage::kFree};
  Question question_{};
  Answer answer_;
};

/// The road of the stops: a bit for each in one word, so that none is refused for want of room, none is lost, and none
/// waits for another request. A stop that comes twice is one.
class StopRoad {
 public:
  static constexpr std::array<MachineEvent, 3> kStops{MachineEvent::kHold, MachineEvent::kCancel,
                                                      MachineEvent::kDisable};

  /// Stops that have come.
  class Taken {
   public:
    explicit Taken(std::uint32_t bits) noexcept : bits_(bits) {}
    bool has(MachineEvent stop) const noexcept { return bits_ & (bit(stop) | askedBit(stop)); }
    bool asked(MachineEvent stop) const noexcept { return bits_ & askedBit(stop); }

   private:
    std::uint32_t bits_;
  };

  /// For any thread and for signal handlers; what is no stop is not taken.
  void post(MachineEvent stop) noexcept { bits_.fetch_or(bit(stop)); }

  /// The same with an answer. For one thread at a time.
  /// @return a ticket, to know the answer by.
  std::uint32_t ask(MachineEvent stop) noexcept;
  /// The answer to a ticket, once there is one. For the asking thread.
  std::optional<Answer> reply(MachineEvent stop, std::uint32_t ticket) const noexcept;

  /// For the loop: all that have come since the last time.
  Taken take() noexcept { return Taken(bits_.exchange(0)); }
  /// For the loop: answers a stop that was asked.
  void answer(const Answer& answer) noexcept;

 private:
  static constexpr std::size_t indexOf(MachineEvent stop) noexcept {
    for (std::size_t i = 0; i < kStops.size(); ++i) {
      if (kStops[i] == stop) return i;
    }
    return kStops.size();
  }
  static constexpr std::uint32_t bit(MachineEvent stop) noexcept { return isStop(stop) ? 1u << indexOf(stop) : 0; }
  static constexpr std::uint32_t askedBit(MachineEvent stop) noexcept { return bit(stop) << kStops.size(); }

  std::atomic<std::uint32_t> bits_{0};
  std::atomic<std::uint32_t> ticket_{0};                             ///< the last one given
  std::array<std::atomic<std::uint64_t>, kStops.size()> answers_{};  ///< ticket, state and refusal in one word
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "signal handlers post stops");
};

}  // namespace flute_grinder
