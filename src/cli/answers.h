#pragma once

#include "cli/call.h"
#include "flute_grinder/Need.h"

#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Puts the needs of a refusal to the operator at the terminal, one after the other, and adds the answers to those of
/// the goal or request. @return whether it is to be sent again: not without a terminal, or if a need is not answered.
bool addAnswers(const std::vector<flute_grinder::Need>& needs, std::vector<std::string>& answers);

/// Calls a service whose refusal may have needs, and asks for the answers.
/// @param request its answers become those that were given. @return the response that succeeded; nothing if there is
/// none, with the reason printed.
template <typename Service>
std::optional<typename Service::Response> callAnswering(ros::NodeHandle& nh, const std::string& service,
                                                        typename Service::Request& request) {
  for (;;) {
    std::optional<typename Service::Response> response = ask<Service>(nh, service, request);
    if (!response || response->success) return response;
    fail(response->message);
    if (!addAnswers(response->needs, request.answers)) return std::nullopt;
  }
}

}  // namespace grinder
