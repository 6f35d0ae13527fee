#include "flute_grinder/network/peer_limits.h"

#include "network/original_symbol.h"

#include <sys/socket.h>

/// Overrides the C library's accept: a connection over the limit is closed before anything is read from it. Its
/// descriptor is returned all the same, because roscpp stops listening for a while after an error.
extern "C" int accept(int fd, sockaddr* address, socklen_t* length) {
  using Accept = int (*)(int, sockaddr*, socklen_t*);
  static const auto next = reinterpret_cast<Accept>(grinder::originalSymbol("accept"));
  const int connection = next(fd, address, length);
  if (connection >= grinder::kMaxPeerDescriptor) shutdown(connection, SHUT_RDWR);
  return connection;
}
