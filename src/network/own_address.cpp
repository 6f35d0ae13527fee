#include "flute_grinder/network/own_address.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <memory>

namespace grinder {

namespace {

/// An IPv4 address in the host's byte order.
in_addr_t addressOf(const addrinfo& found) {
  return ntohl(reinterpret_cast<const sockaddr_in*>(found.ai_addr)->sin_addr.s_addr);
}

const in6_addr& address6Of(const addrinfo& found) {
  return reinterpret_cast<const sockaddr_in6*>(found.ai_addr)->sin6_addr;
}

bool isLoopback(const addrinfo& found) {
  return found.ai_family == AF_INET ? addressOf(found) >> 24U == IN_LOOPBACKNET
                                    : IN6_IS_ADDR_LOOPBACK(&address6Of(found));
}

bool isEveryAddress(const addrinfo& found) {
  return found.ai_family == AF_INET ? addressOf(found) == INADDR_ANY : IN6_IS_ADDR_UNSPECIFIED(&address6Of(found));
}

/// Whether roscpp uses IPv6.
bool usesIpv6() {
  const char* value = std::getenv("ROS_IPV6");
  return value && std::string(value) == "on";
}

std::string ownHostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace

std::string ownAddressRefusal() {
  const char* variable = std::getenv("ROS_HOSTNAME") ? "ROS_HOSTNAME" : "ROS_IP";
  const char* value = std::getenv(variable);
  const std::string allowed =
      "; allowed: 127.0.0.1 or localhost for this computer alone, or the address under which others reach it";
  if (!value) return "neither ROS_HOSTNAME nor ROS_IP is set, and every computer could move the machine" + allowed;
  const std::string name = value;
  if (name.empty()) return std::string(variable) + " is empty" + allowed;
  if (name.find(':') != std::string::npos && !usesIpv6()) {
    return std::string(variable) + " = " + name +
           " is an address of IPv6; allowed: one of IPv4, or ROS_IPV6=on beside it";
  }
  if (isLoopbackName(name)) return "";
  addrinfo* list = nullptr;
  const int error = getaddrinfo(name.c_str(), nullptr, nullptr, &list);
  if (error != 0) return std::string(variable) + " = " + name + " has no address: " + gai_strerror(error) + allowed;
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> found(list, freeaddrinfo);
  if (isEveryAddress(*found)) return std::string(variable) + " = " + name + " is every address" + allowed;
  // /etc/hosts often maps the host's own name to loopback; other computers still reach it by that name.
  if (!isLoopback(*found) || name == ownHostName()) return "";
  return std::string(variable) + " = " + name + " is loopback in words that ROS does not know" + allowed;
}

}  // namespace grinder
