#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace grinder {

/// Called with a message that is dropped because it is longer than kMaxPeerMessage: its length as announced [bytes],
/// and its beginning, at most kDroppedHead bytes. In roscpp's network thread: it must not wait, and not throw.
using OnDropped = std::function<void(std::uint32_t length, std::vector<std::uint8_t> head)>;

constexpr std::uint32_t kDroppedHead = 1024;  ///< [bytes]

/// Sets who is called for a topic, for instance to answer. Thread safe.
/// @param topic resolved name. @param on_dropped empty for nobody.
void setOnDropped(const std::string& topic, OnDropped on_dropped);

/// Calls whoever is set for the topic, if anybody is. Thread safe.
void reportDropped(const std::string& topic, std::uint32_t length, std::vector<std::uint8_t> head);

}  // namespace grinder
