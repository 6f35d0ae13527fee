/// @file
/// Limits for XML-RPC, by which a node is told of publishers and asked about itself. libxmlrpcpp has none: it takes a
/// text of any length, and reads nested values by recursion, to the end of the stack. These definitions of its
/// functions stand before the library's own in the node's program.

#include "flute_grinder/node/peer_limits.h"

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
using flute_grinder::nextDefinition;

namespace XmlRpc {

/// A socket to ask a peer; none, so that the peer is not asked, where too many are open.
int XmlRpcSocket::socket() {
  using Socket = int (*)();
  static const auto next = reinterpret_cast<Socket>(nextDefinition("_ZN6XmlRpc12XmlRpcSocket6socketEv"));
  const int fd = next();
  if (fd < kMaxAskedDescriptor) return fd;
  close(fd);
  errno = EMFILE;
  return -1;
}

/// Appends what can be read without waiting.
/// @return false, upon which the library closes the connection, after an error or when the text is too long.
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

/// Reads a value, which reads those in it in the same way.
/// @return false where they are nested too deep, as for any other text that is no value.
bool XmlRpcValue::fromXml(const std::string& xml, int* offset) {
  using FromXml = bool (*)(XmlRpcValue*, const std::string&, int*);
  static const auto next = reinterpret_cast<FromXml>(
      nextDefinition("_ZN6XmlRpc11XmlRpcValue7fromXmlERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEPi"));
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

/// Calls of several methods at once are an unknown method: nobody asks a node that way, and one within another makes
/// the library call itself without end.
bool XmlRpcServerConnection::executeMulticall(const std::string&, XmlRpcValue&, XmlRpcValue&) { return false; }

}  // namespace XmlRpc
