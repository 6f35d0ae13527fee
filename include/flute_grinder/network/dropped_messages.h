#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace grinder {

/// Called for a message that is dropped because it is longer than kMaxPeerMessage, with its announced length [bytes]
/// and at most the first kDroppedHead bytes. Called in roscpp's network thread: must not wait or throw.
using OnDropped = std::function<void(std::uint32_t length, std::vector<std::uint8_t> head)>;

constexpr std::uint32_t kDroppedHead = 1024;  ///< longest beginning of a dropped message [bytes]

/// Sets the function to call for a topic, for instance to answer. Thread safe.
/// @param topic resolved name. @param on_dropped empty for none.
void setOnDropped(const std::string& topic, OnDropped on_dropped);

/// Calls the function set for the topic, if there is one. Thread safe.
void reportDropped(const std::string& topic, std::uint32_t length, std::vector<std::uint8_t> head);

}  // namespace grinder
