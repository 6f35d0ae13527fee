/// @file
/// Limits for connections of topics and services. roscpp allocates any length that a peer announces, up to 1 GB, and
/// copies it for each callback: a client with a bug could exhaust the computer's memory and end the job. These
/// definitions override the library's in the node's program.

#include "flute_grinder/network/dropped_messages.h"
#include "flute_grinder/network/peer_limits.h"
#include "network/original_symbol.h"

#include <ros/connection.h>
#include <ros/console.h>
#include <ros/subscription.h>
#include <ros/transport/transport_udp.h>
#include <ros/transport_publisher_link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

using grinder::kDroppedHead;
using grinder::kMaxPeerMessage;
using grinder::originalSymbol;

namespace {

constexpr std::uint32_t kPiece = 16384;  ///< length to skip at a time [bytes]

/// Reads bytes and discards them.
/// @param then called after the last byte, unless the connection ends before.
void skip(const ros::ConnectionPtr& connection, std::uint32_t size, const std::function<void()>& then) {
  if (size == 0) return then();
  connection->read(std::min(size, kPiece),
                   [size, then](const ros::ConnectionPtr& from, const auto&, std::uint32_t read, bool success) {
                     if (success) skip(from, size - read, then);
                   });
}

}  // namespace

namespace ros {

/// Called when a publisher has announced the length of its next message. A message that is too long is skipped, and the
/// connection stays, so that later messages arrive: roscpp never reopens a connection that its subscriber has closed.
void TransportPublisherLink::onMessageLength(const ConnectionPtr& connection,
                                             const boost::shared_array<std::uint8_t>& buffer, std::uint32_t size,
                                             bool success) {
  using OnLength = void (*)(TransportPublisherLink*, const ConnectionPtr&, const boost::shared_array<std::uint8_t>&,
                            std::uint32_t, bool);
  static const auto next = reinterpret_cast<OnLength>(
      originalSymbol("_ZN3ros22TransportPublisherLink15onMessageLengthERKN5boost10shared_ptrINS_10ConnectionEEERKNS1_"
                     "12shared_arrayIhEEjb"));
  std::uint32_t length = 0;
  if (success) std::memcpy(&length, buffer.get(), sizeof length);
  if (length <= kMaxPeerMessage) return next(this, connection, buffer, size, success);
  const SubscriptionPtr subscription = parent_.lock();
  const std::string topic = subscription ? subscription->getName() : "a topic";
  ROS_WARN_STREAM("a message of " << length << " bytes on " << topic << " is dropped; allowed: " << kMaxPeerMessage
                                  << ": " << connection->getRemoteString());
  const auto read_next = [this] {
    connection_->read(sizeof length, [this](const auto&... read) { onMessageLength(read...); });
  };
  connection->read(kDroppedHead, [=](const ConnectionPtr& from, const boost::shared_array<std::uint8_t>& head,
                                     std::uint32_t read, bool good) {
    if (!good) return;
    grinder::reportDropped(topic, length, std::vector<std::uint8_t>(head.get(), head.get() + read));
    skip(from, length - read, read_next);
  });
}

/// Reads a header, a request, or a message of the announced length; drops the connection if the length is too large.
void Connection::read(uint32_t size, const ReadFinishedFunc& finished) {
  using Read = void (*)(Connection*, uint32_t, const ReadFinishedFunc&);
  static const auto next = reinterpret_cast<Read>(originalSymbol(
      "_ZN3ros10Connection4readEjRKN5boost8functionIFvRKNS1_10shared_ptrIS0_EERKNS1_12shared_arrayIhEEjbEEE"));
  if (size <= kMaxPeerMessage) {
    next(this, size, finished);
  } else {
    ROS_WARN_STREAM("a peer announces " << size << " bytes; allowed: " << kMaxPeerMessage << ": " << getRemoteString());
    drop(HeaderError);
  }
}

/// Opens the UDP port, which roscpp polls but never reads: a single datagram, as from a port scan, would keep its
/// thread busy for ever.
bool TransportUDP::createIncoming(int port, bool is_server) {
  using Create = bool (*)(TransportUDP*, int, bool);
  static const auto next = reinterpret_cast<Create>(originalSymbol("_ZN3ros12TransportUDP14createIncomingEib"));
  if (!next(this, port, is_server)) return false;
  if (is_server) disableRead();
  return true;
}

}  // namespace ros
