#include "flute_grinder/control/request_box.h"

#include "flute_grinder/base/await.h"

#include <chrono>
#include <cmath>
#include <string>

namespace grinder {

namespace {

using Seconds = std::chrono::duration<double>;

/// Timeout of a request's answer, in addition to the time that the request itself may take.
constexpr Seconds kAnswerTimeout(2);
/// Timeout of a stop's answer.
constexpr Seconds kStopTimeout(0.1);
constexpr std::chrono::microseconds kAnswerLook(100);  ///< time between looks for an answer

/// Polls for an answer until one is available or the timeout expires.
/// @param poll returns the answer, or nothing yet.
template <typename Poll>
RequestReply awaitReply(const char* request, Seconds timeout, const Poll& poll) {
  std::optional<RequestReply> answer;
  await(std::chrono::duration_cast<std::chrono::nanoseconds>(timeout), kAnswerLook, [&] {
    answer = poll();
    return answer.has_value();
  });
  return answer.value_or(RequestReply{false, std::string(request) + ": the control loop does not answer", false});
}

std::optional<RequestReply> toReply(const std::optional<Answer>& answer) {
  if (answer) return answer->reply();
  return std::nullopt;
}

/// Posts a request, and waits for its answer.
template <typename Request>
RequestReply ask(const char* name, Seconds timeout, RequestSlot<Request>& slot, const Request& request) {
  bool posted = false;
  RequestReply reply = awaitReply(name, timeout, [&]() -> std::optional<RequestReply> {
    // The slot may still contain a request that timed out.
    if (posted) return toReply(slot.reply());
    posted = slot.post(request);
    return std::nullopt;
  });
  // A request that nobody waits for any more must not be executed later.
  slot.withdraw();
  return reply;
}

}  // namespace

RequestReply RequestBox::request(MachineEvent event) {
  if (!isTrigger(event)) {
    return {false, std::string(toString(event)) + " refused: allowed: " + namesOf<MachineEvent>(isTrigger), true};
  }
  return ask(toString(event), kAnswerTimeout + Seconds(enable_timeout_), requests_, event);
}

std::optional<RequestReply> RequestBox::reply() { return toReply(requests_.reply()); }

RequestReply RequestBox::confirmSwivel(double angle) {
  if (!(std::abs(angle) <= kMaxSwivel)) {
    const auto degrees = [](double value) { return text(Quantity{value, Unit::kRadian}); };
    return {false,
            "confirm-swivel refused: " + degrees(angle) + "; allowed: -" + degrees(kMaxSwivel) + " to " +
                degrees(kMaxSwivel),
            true};
  }
  return ask("confirm-swivel", kAnswerTimeout, swivels_, angle);
}

std::optional<RequestReply> RequestBox::swivelReply() { return toReply(swivels_.reply()); }

RequestReply RequestBox::stop(MachineEvent event) {
  if (!isStop(event)) {
    return {false, std::string(toString(event)) + " refused: allowed: hold, cancel, disable", true};
  }
  const std::uint32_t ticket = postStopWithReply(event);
  return awaitReply(toString(event), kStopTimeout, [&] { return stopReply(event, ticket); });
}

std::optional<RequestReply> RequestBox::stopReply(MachineEvent event, std::uint32_t ticket) const {
  return toReply(stops_.reply(event, ticket));
}

RequestReply RequestBox::jog(const JogRequest& jog) {
  return ask(toString(MachineEvent::kJog), kAnswerTimeout, jogs_, jog);
}

std::optional<RequestReply> RequestBox::jogReply() { return toReply(jogs_.reply()); }

RequestReply RequestBox::jogInSeries(const JogRequest& jog) {
  return ask(toString(MachineEvent::kJog), kAnswerTimeout, series_jogs_, jog);
}

std::optional<RequestReply> RequestBox::startJobReply() { return toReply(job_starts_.reply()); }

}  // namespace grinder
