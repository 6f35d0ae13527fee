/// @file
/// Limits for the connections of topics and services. roscpp makes room for whatever length a peer claims, up to 1 GB,
/// believes what a publisher answers, and lets anybody choose the size of UDPROS's datagrams, by which it divides.
/// These definitions of its functions stand before the library's own in the node's program.

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

/// Whether an answer to requestTopic, [code, text, protocol], may be looked into: TCPROS, host and port, or none.
bool isAddressOfTcpros(XmlRpcValue& answer) {
  if (answer.getType() != XmlRpcValue::TypeArray || answer.size() != 3) return false;
  XmlRpcValue& protocol = answer[2];
  return protocol.getType() == XmlRpcValue::TypeArray && protocol.size() == 3 &&
         protocol[0].getType() == XmlRpcValue::TypeString && static_cast<std::string&>(protocol[0]) == "TCPROS";
}

}  // namespace

namespace ros {

/// Makes room for what a peer has announced, and drops the connection of one that announces too much.
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

/// A publisher has answered where its topic is to be had. Anything but an address becomes a plain refusal.
void Subscription::pendingConnectionDone(const PendingConnectionPtr& connection, XmlRpcValue& answer) {
  using Done = void (*)(Subscription*, const PendingConnectionPtr&, XmlRpcValue&);
  static const auto next =
      reinterpret_cast<Done>(nextDefinition("_ZN3ros12Subscription21pendingConnectionDoneERKN5boost10shared_ptrINS0_"
                                            "17PendingConnectionEEERN6XmlRpc11XmlRpcValueE"));
  if (!isAddressOfTcpros(answer)) answer.clear();
  next(this, connection, answer);
}

/// Opens the port for datagrams, which roscpp watches but never reads: one datagram would keep its thread busy for
/// good.
bool TransportUDP::createIncoming(int port, bool is_server) {
  using Create = bool (*)(TransportUDP*, int, bool);
  static const auto next = reinterpret_cast<Create>(nextDefinition("_ZN3ros12TransportUDP14createIncomingEib"));
  if (!next(this, port, is_server)) return false;
  if (is_server) disableRead();
  return true;
}

/// Never: the node speaks TCPROS alone.
TransportUDPPtr TransportUDP::createOutgoing(std::string, int, int, int) { return {}; }

}  // namespace ros
