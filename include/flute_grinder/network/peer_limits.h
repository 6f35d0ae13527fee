#pragma once

#include <cstddef>

namespace grinder {

// Limits on the resources that a faulty peer can take from the node. docs/network.md lists them.

/// Longest message of a topic, header, and request or response of a service [bytes]; enough for a goal with 32 thousand
/// teeth.
constexpr std::size_t kMaxPeerMessage = 262144;

/// No connection is accepted from this file descriptor on; the rest are reserved for the node itself.
constexpr int kMaxPeerDescriptor = 512;

}  // namespace grinder
