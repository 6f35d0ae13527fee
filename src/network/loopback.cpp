/// @file
/// Keeps a roscpp node's servers on loopback. If ROS_IP or ROS_HOSTNAME names loopback, roscpp binds the servers of
/// topics and services to it, but the XML-RPC server always to all interfaces, where anyone could shut the node down.
/// This bind() overrides the C library's, and binds every server to loopback then. Preloaded as a library, it protects
/// other nodes too.

#include "flute_grinder/network/own_address.h"

#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdlib>
#include <cstring>

namespace {

/// Whether ROS is configured for loopback; ROS_HOSTNAME comes before ROS_IP, as in roscpp.
bool loopbackOnly() {
  const char* host = std::getenv("ROS_HOSTNAME");
  if (!host) host = std::getenv("ROS_IP");
  return host && grinder::isLoopbackName(host);
}

/// An address, with loopback in place of all interfaces.
sockaddr_storage onLoopback(const sockaddr* address, socklen_t length) {
  sockaddr_storage local{};
  std::memcpy(&local, address, length);
  auto& four = reinterpret_cast<sockaddr_in&>(local);
  auto& six = reinterpret_cast<sockaddr_in6&>(local);
  if (local.ss_family == AF_INET && four.sin_addr.s_addr == htonl(INADDR_ANY)) {
    four.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  if (local.ss_family == AF_INET6 && IN6_IS_ADDR_UNSPECIFIED(&six.sin6_addr)) six.sin6_addr = in6addr_loopback;
  return local;
}

}  // namespace

extern "C" int bind(int fd, const sockaddr* address, socklen_t length) noexcept {
  using Bind = int (*)(int, const sockaddr*, socklen_t);
  static const auto next = reinterpret_cast<Bind>(dlsym(RTLD_NEXT, "bind"));
  if (!address || length > sizeof(sockaddr_storage) || !loopbackOnly()) return next(fd, address, length);
  const sockaddr_storage local = onLoopback(address, length);
  return next(fd, reinterpret_cast<const sockaddr*>(&local), length);
}
