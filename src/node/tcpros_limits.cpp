/// @file
/// Limits for connections of topics and services. roscpp allocates whatever length a peer claims, up to 1 GB, trusts
/// the answer of a publisher, and divides by a UDPROS datagram size that the peer chooses. These definitions override
/// the library's own in the node's program.

#include "flute_grinder/connection/next_definition.h"
#include "flute_grinder/node/peer_limits.h"

#include <ros/connection.h>
#include <ros/console.h>
#include <ros/subscription.h>
#include <ros/transport/transport_udp.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>

using flute_grinder::kMaxPeerMessage;
using flute_grinder::nextDefinition;
using XmlRpc::XmlRpcValue;

namespace {

/// Whether an answer to requestTopic, [code, text, protocol], is well formed: TCPROS, host and port, or no protocol.
bool isAddressOfTcpros(XmlRpcValue& answer) {
  if (answer.getType() != XmlRpcValue::TypeArray || answer.size() != 3) return false;
  XmlRpcValue& protocol = answer[2];
  return protocol.getType() == XmlRpcValue::TypeArray && protocol.size() == 3 &&
         protocol[0].getType() == XmlRpcValue::TypeString && static_cast<std::string&>(protocol[0]) == "TCPROS";
}

}  // namespace

namespace ros {

/// Reads a message of the announced length; drops the connection if that is too long.
void Connection::read(uint32_t size, const ReadFinishedFunc& finished) {
  using Read = void (*)(Connection*, uint32_t, const ReadFinishedFunc&);
  static const auto next = reinterpret_cast<Read>(nextDefinition(
      "_ZN3ros10Connection4readEjRKN5boost8functionIFvRKNS1_10shared_ptrIS0_EERKNS1_12shared_arrayIhEEjbEEE"));
  if (size <= kMaxPeerMessage) {
    next(this, size, finished);
  } else {
    ROS_WARN_STREAM("a peer announces " << size << " bytes; allowed: " << kMaxPeerMessage << ": " << getRemoteString());
    drop(HeaderError);
  }
}

/// A publisher has answered with its address. Anything else is turned into a plain refusal.
void Subscription::pendingConnectionDone(const PendingConnectionPtr& connection, XmlRpcValue& answer) {
  using Done = void (*)(Subscription*, const PendingConnectionPtr&, XmlRpcValue&);
  static const auto next =
      reinterpret_cast<Done>(nextDefinition("_ZN3ros12Subscription21pendingConnectionDoneERKN5boost10shared_ptrINS0_"
                                            "17PendingConnectionEEERN6XmlRpc11XmlRpcValueE"));
  if (!isAddressOfTcpros(answer)) answer.clear();
  next(this, connection, answer);
}

/// Opens the UDP port, which roscpp polls but never reads: a single datagram would keep its thread busy for ever.
bool TransportUDP::createIncoming(int port, bool is_server) {
  using Create = bool (*)(TransportUDP*, int, bool);
  static const auto next = reinterpret_cast<Create>(nextDefinition("_ZN3ros12TransportUDP14createIncomingEib"));
  if (!next(this, port, is_server)) return false;
  if (is_server) disableRead();
  return true;
}

/// Refused: the node uses TCPROS only.
TransportUDPPtr TransportUDP::createOutgoing(std::string, int, int, int) { return {}; }

}  // namespace ros
