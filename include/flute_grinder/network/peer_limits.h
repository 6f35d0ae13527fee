#pragma once

#include <cstddef>

namespace flute_grinder {

// Limits on what any peer can send; ROS 1 has no authentication. docs/network.md lists them.

/// Longest XML-RPC or TCPROS message [bytes]; the longest legitimate one carries robot_description.
constexpr std::size_t kMaxPeerMessage = 262144;

/// Deepest nesting of arrays and structures in XML-RPC, which is parsed recursively; ROS itself needs four levels.
constexpr int kMaxPeerNesting = 32;

/// No connection is accepted from this file descriptor on; the rest are reserved for the node itself.
constexpr int kMaxPeerDescriptor = 512;

/// From this one on the node opens no connection to a publisher, so that incoming connections find room.
constexpr int kMaxAskedDescriptor = 256;

}  // namespace flute_grinder
