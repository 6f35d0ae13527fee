/// @file
/// Keeps the node's XML-RPC server on loopback. roscpp binds the servers of topics and services to loopback when ROS_IP
/// or ROS_HOSTNAME names it, but that of the XML-RPC API always to all interfaces, where anybody could shut the node
/// down. The program's own bind() stands before the C library's, and applies the same rule to every server.

#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdlib>
#include <string>

namespace {

/// Whether ROS is told to use loopback; ROS_HOSTNAME comes before ROS_IP, as in roscpp.
bool loopbackOnly() {
  const char* host = std::getenv("ROS_HOSTNAME");
  if (!host) host = std::getenv("ROS_IP");
  return host && (std::string(host) == "localhost" || std::string(host).rfind("127.", 0) == 0);
}

}  // namespace

extern "C" int bind(int fd, const sockaddr* address, socklen_t length) noexcept {
  using Bind = int (*)(int, const sockaddr*, socklen_t);
  static const auto next = reinterpret_cast<Bind>(dlsym(RTLD_NEXT, "bind"));
  if (address->sa_family == AF_INET && length >= sizeof(sockaddr_in) && loopbackOnly()) {
    sockaddr_in local = *reinterpret_cast<const sockaddr_in*>(address);
    if (local.sin_addr.s_addr == htonl(INADDR_ANY)) local.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return next(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local);
  }
  return next(fd, address, length);
}
