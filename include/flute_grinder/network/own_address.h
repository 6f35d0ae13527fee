#pragma once

#include <string>

namespace grinder {

/// Whether roscpp takes a name in ROS_HOSTNAME or ROS_IP for loopback.
inline bool isLoopbackName(const std::string& name) {
  return name == "localhost" || name == "::1" || name.rfind("127.", 0) == 0;
}

/// Why the node must not start under the address that the environment gives it. For a name that is unset, empty,
/// unknown, the address of all interfaces, or a loopback name that roscpp does not recognise, roscpp would silently
/// listen on all addresses of this computer. With an IPv6 address but without ROS_IPV6 it would reach nobody. May ask
/// the resolver.
/// @return a message; empty if the address is good.
std::string ownAddressRefusal();

}  // namespace grinder
