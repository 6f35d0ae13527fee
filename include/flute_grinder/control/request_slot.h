#pragma once

#include "flute_grinder/control/loop_requests.h"

#include <atomic>
#include <cstdint>
#include <optional>

namespace grinder {

/// Holds one request from one thread to the control loop, and its answer. Neither side ever waits for the other.
template <typename Request>
class RequestSlot {
 public:
  /// For the requesting thread.
  /// @return false while the previous request is unanswered; an unread answer is dropped.
  bool post(const Request& request) noexcept {
    const Stage stage = stage_.load(std::memory_order_acquire);
    if (stage == Stage::kPosted || stage == Stage::kTaken) return false;
    request_ = request;
    stage_.store(Stage::kPosted, std::memory_order_release);
    return true;
  }
  /// For the requesting thread: returns the answer once.
  std::optional<Answer> reply() noexcept {
    if (stage_.load(std::memory_order_acquire) != Stage::kAnswered) return std::nullopt;
    const Answer answer = answer_;
    stage_.store(Stage::kFree, std::memory_order_relaxed);
    return answer;
  }
  /// For the requesting thread, when it stops waiting: a request that the loop has not taken is dropped.
  void withdraw() noexcept {
    Stage posted = Stage::kPosted;
    stage_.compare_exchange_strong(posted, Stage::kFree, std::memory_order_relaxed);
  }

  /// For the loop: returns the posted request once.
  std::optional<Request> take() noexcept {
    Stage posted = Stage::kPosted;
    if (!stage_.compare_exchange_strong(posted, Stage::kTaken, std::memory_order_acquire)) return std::nullopt;
    return request_;
  }
  /// For the loop: answers the request it took, in the same cycle or a later one.
  void answer(const Answer& answer) noexcept {
    answer_ = answer;
    stage_.store(Stage::kAnswered, std::memory_order_release);
  }

 private:
  enum class Stage : std::uint8_t { kFree, kPosted, kTaken, kAnswered };

  std::atomic<Stage> stage_{Stage::kFree};
  Request request_{};
  Answer answer_;
};

}  // namespace grinder
