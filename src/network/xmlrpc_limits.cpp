/// @file
/// Limits for XML-RPC, the protocol of a node's own API. libxmlrpcpp has none: it accepts text of any length, and
/// parses nested values recursively until the stack overflows. These definitions override the library's own in the
/// node's program.

#include "flute_grinder/network/peer_limits.h"
#include "network/original_symbol.h"

#include <unistd.h>
#include <xmlrpcpp/XmlRpcServerConnection.h>
#include <xmlrpcpp/XmlRpcSocket.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <array>
#include <cerrno>
#include <string>

using flute_grinder::kMaxAskedDescriptor;
using flute_grinder::kMaxPeerMessage;
using flute_grinder::kMaxPeerNesting;
using flute_grinder::originalSymbol;

namespace XmlRpc {

/// A socket for a request to a peer; fails, so that no request is made, if too many are open.
int XmlRpcSocket::socket() {
  using Socket = int (*)();
  static const auto next = reinterpret_cast<Socket>(originalSymbol("_ZN6XmlRpc12XmlRpcSocket6socketEv"));
  const int fd = next();
  if (fd < kMaxAskedDescriptor) return fd;
  close(fd);
  errno = EMFILE;
  return -1;
}

/// Appends what can be read without blocking.
/// @return false after an error or if the text is too long; the library then closes the connection.
bool XmlRpcSocket::nbRead(int fd, std::string& text, bool* eof) {
  *eof = false;
  std::array<char, 4096> piece;
  while (text.size() <= kMaxPeerMessage) {
    const ssize_t size = read(fd, piece.data(), piece.size());
    if (size > 0) {
      text.append(piece.data(), static_cast<std::size_t>(size));
      continue;
    }
    *eof = size == 0;
    return *eof || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
  }
  errno = EMSGSIZE;
  return false;
}

/// Parses a value and, recursively, those inside it.
/// @return false if they are nested too deep, as for any other text that is not a value.
bool XmlRpcValue::fromXml(const std::string& xml, int* offset) {
  using FromXml = bool (*)(XmlRpcValue*, const std::string&, int*);
  static const auto next = reinterpret_cast<FromXml>(
      originalSymbol("_ZN6XmlRpc11XmlRpcValue7fromXmlERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEPi"));
  static thread_local int depth = 0;
  struct Level {
    Level() { ++depth; }
    ~Level() { --depth; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
  };
  const Level level;
  return depth <= kMaxPeerNesting && next(this, xml, offset);
}

/// system.multicall is reported as an unknown method: no ROS client uses it, and a nested one makes the library recurse
/// without end.
bool XmlRpcServerConnection::executeMulticall(const std::string&, XmlRpcValue&, XmlRpcValue&) { return false; }

}  // namespace XmlRpc
