#pragma once

#include <cstddef>

namespace flute_grinder {

// What a peer may have of the node, whoever it is: the ports ask for no name. docs/network.md lists them.

/// Longest message [bytes]: of XML-RPC, whose longest is the one with robot_description, and of TCPROS.
constexpr std::size_t kMaxPeerMessage = 262144;

/// Deepest nesting of arrays and structures in XML-RPC, which is read by recursion; ROS's own go four deep.
constexpr int kMaxPeerNesting = 32;

/// From this file descriptor on, which tells how many are open, no connection is taken: what is left is the node's own.
constexpr int kMaxPeerDescriptor = 512;

/// From this one on no publisher is asked where its topic is to be had, so that those who ask the node find room.
constexpr int kMaxAskedDescriptor = 256;

/// The definition of a function that comes next after the program's own, in a shared library.
/// @param symbol its name for the linker.
/// Ends the program where there is none: the node must not run with a limit that does not act.
void* nextDefinition(const char* symbol);

}  // namespace flute_grinder
