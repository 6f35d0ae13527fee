#pragma once

#include "cli/online.h"
#include "cli/waiting.h"
#include "flute_grinder/network/service_call.h"

#include <ros/ros.h>

#include <optional>
#include <string>

namespace grinder {

/// Calls a service of the grinder, and prints why if there is no answer. Without a GrinderClient, for whose topics a
/// command that only asks would have to wait.
/// @return nothing without an answer.
template <typename Service>
std::optional<typename Service::Response> ask(ros::NodeHandle& nh, const std::string& service,
                                              const typename Service::Request& request) {
  ros::ServiceClient there = nh.serviceClient<Service>(service);
  if (!await(kPatience, [&] { return there.exists(); })) {
    noGrinder(nh);
    return std::nullopt;
  }
  std::optional<typename Service::Response> response;
  ServiceCall running(nh.resolveName(service), ros::service_traits::md5sum<Service>(),
                      ros::serialization::serializeMessage(request), kPatience,
                      [&](ros::SerializedMessage* message) { response = responseFrom<Service>(message); });
  await(kPatience, [&] { return running.finished(); });
  running.end();
  if (!response) {
    fail(service + ": no answer from the grinder " + nh.getNamespace() +
         "; the request may or may not have been carried out");
  }
  return response;
}

/// Calls a service that may refuse, and prints why if it refuses or does not answer. @return the exit status.
template <typename Service>
int call(ros::NodeHandle& nh, const std::string& service, const typename Service::Request& request) {
  const std::optional<typename Service::Response> response = ask<Service>(nh, service, request);
  if (!response) return 1;
  return response->success ? 0 : fail(response->message);
}

}  // namespace grinder
