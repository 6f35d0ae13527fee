#include "flute_grinder/control/request_box.h"

#include <chrono>
#include <string>
#include <thread>

namespace flute_grinder {

namespace {

using Clock = std::chrono::steady_clock;

/// Timeout of a request's answer, in addition to the time that the request itself may take [s].
constexpr double kAnswerTimeout = 2;
/// Timeout of a stop's answer [s].
constexpr double kStopTimeout = 0.1;

/// Polls for an answer until one is available or the timeout expires.
/// @param poll returns the answer, or nothing yet.
/// @param timeout [s].
template <typename Poll>
RequestReply await(MachineEvent event, double timeout, const Poll& poll) {
  const auto deadline = Clock::now() + std::chrono::duration<double>(timeout);
  while (Clock::now() < deadline) {
    if (const std::optional<RequestReply> answer = poll()) return *answer;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return {false, std::string(toString(event)) + ": the control loop does not answer", false};
}

std::optional<RequestReply> toReply(const std::optional<Answer>& answer) {
  if (answer) return answer->reply();
  return std::nullopt;
}

}  // namespace

RequestReply RequestBox::request(MachineEvent event) {
  if (!isTrigger(event)) {
    return {false, std::string(toString(event)) + " refused: allowed: " + namesOf<MachineEvent>(isTrigger), true};
  }
  bool posted = false;
  return await(event, kAnswerTimeout + enable_timeout_, [&]() -> std::optional<RequestReply> {
    // The slot may still contain a request that timed out.
    if (posted) return reply();
    posted = post(event);
    return std::nullopt;
  });
}

std::optional<RequestReply> RequestBox::reply() { return toReply(requests_.reply()); }

RequestReply RequestBox::stop(MachineEvent event) {
  if (!isStop(event)) {
    return {false, std::string(toString(event)) + " refused: allowed: hold, cancel, disable", true};
  }
  const std::uint32_t ticket = postStopWithReply(event);
  return await(event, kStopTimeout, [&] { return stopReply(event, ticket); });
}

std::optional<RequestReply> RequestBox::stopReply(MachineEvent event, std::uint32_t ticket) const {
  return toReply(stops_.reply(event, ticket));
}

bool RequestBox::startJob(SetpointStream* stream) noexcept {
  return job_starts_.post(JobStart{stream, wheelOf(stream->program())});
}

std::optional<RequestReply> RequestBox::startJobReply() { return toReply(job_starts_.reply()); }

}  // namespace flute_grinder
