#include "flute_grinder/client/requests.h"

#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/network/user_at_host.h"

namespace grinder {

namespace {

template <typename Request>
Request requestFor(const OffsetBasis& basis, const std::vector<std::string>& answers) {
  Request request;
  request.basis = toMessage(basis);
  request.answers = answers;
  request.set_by = userAtHost();
  return request;
}

}  // namespace

flute_grinder::SetOffsets::Request offsetsRequest(const OffsetValues& values, const OffsetBasis& basis,
                                                  const std::vector<std::string>& answers) {
  auto request = requestFor<flute_grinder::SetOffsets::Request>(basis, answers);
  for (const auto& [axis, value] : values) {
    request.axes.push_back(static_cast<std::uint8_t>(axis));
    request.values.push_back(value);
  }
  return request;
}

flute_grinder::TouchOff::Request touchOffRequest(int axis, double position, const OffsetBasis& basis,
                                                 const std::vector<std::string>& answers) {
  auto request = requestFor<flute_grinder::TouchOff::Request>(basis, answers);
  request.axis = static_cast<std::uint8_t>(axis);
  request.position = position;
  return request;
}

flute_grinder::ConfirmWheel::Request wheelRequest(const OffsetBasis& job, bool again) {
  flute_grinder::ConfirmWheel::Request request;
  request.job = toMessage(job);
  request.again = static_cast<std::uint8_t>(again);
  request.set_by = userAtHost();
  return request;
}

flute_grinder::Reclamped::Request reclampedRequest() {
  flute_grinder::Reclamped::Request request;
  request.set_by = userAtHost();
  return request;
}

flute_grinder::JogStep::Request jogRequest(int axis, double distance, double speed) {
  flute_grinder::JogStep::Request request;
  request.axis = static_cast<std::uint8_t>(axis);
  request.distance = distance;
  request.speed = speed;
  return request;
}

}  // namespace grinder
