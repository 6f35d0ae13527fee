#pragma once

#include <string>

namespace grinder {

/// Whether roscpp takes a name in ROS_HOSTNAME or ROS_IP for loopback.
inline bool isLoopbackName(const std::string& name) {
  return name == "localhost" || name == "::1" || name.rfind("127.", 0) == 0;
}

/// Why the node must not start under the address that the environment gives it: roscpp would listen on all addresses of
/// this computer, without a word, for a name that is not set, is empty, is unknown, is the address of all, or means
/// loopback but is not written as roscpp expects it; and it would reach nobody by IPv6 that is not switched on. May ask
/// the resolver.
/// @return a message; empty if the address is good.
std::string ownAddressRefusal();

}  // namespace grinder
