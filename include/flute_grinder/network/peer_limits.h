#pragma once

#include <cstddef>

namespace grinder {

// Limits on what a peer that makes a mistake can take of the node. docs/network.md lists them.

/// Longest message of a topic, header and request or response of a service [bytes]; a goal of it has 32 thousand teeth.
constexpr std::size_t kMaxPeerMessage = 262144;

/// No connection is accepted from this file descriptor on; the rest are reserved for the node itself.
constexpr int kMaxPeerDescriptor = 512;

}  // namespace grinder
