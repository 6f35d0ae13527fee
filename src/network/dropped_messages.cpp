#include "flute_grinder/network/dropped_messages.h"

#include <map>
#include <mutex>
#include <utility>

namespace grinder {

namespace {

struct Handlers {
  std::mutex mutex;
  std::map<std::string, OnDropped> of_topics;
};

Handlers& handlers() {
  static Handlers all;
  return all;
}

}  // namespace

void setOnDropped(const std::string& topic, OnDropped on_dropped) {
  const std::lock_guard<std::mutex> lock(handlers().mutex);
  handlers().of_topics[topic] = std::move(on_dropped);
}

void reportDropped(const std::string& topic, std::uint32_t length, std::vector<std::uint8_t> head) {
  // Held during the call, so that a handler is not called after it was replaced.
  const std::lock_guard<std::mutex> lock(handlers().mutex);
  const auto found = handlers().of_topics.find(topic);
  if (found != handlers().of_topics.end() && found->second) found->second(length, std::move(head));
}

}  // namespace grinder
