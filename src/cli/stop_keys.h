#pragma once

#include "flute_grinder/client/grinder_client.h"

#include <atomic>
#include <functional>
#include <thread>

namespace grinder {

/// The keys that stop a motion: the command defines what Ctrl-C does, Ctrl-Z holds on the path. They are handled in
/// their own thread, so that a blocked terminal cannot delay a stop, and use a topic, whose connection survives the
/// master.
class StopKeys {
 public:
  /// @param client must outlive this object.
  explicit StopKeys(const GrinderClient& client) : client_(client) {}
  ~StopKeys();

  /// Starts handling the keys, including any pressed since catchInterrupts() and catchHolds(). The client is connected.
  /// @param on_interrupt called in the keys' thread, after each Ctrl-C.
  void start(std::function<void()> on_interrupt);

 private:
  void run(const std::function<void()>& on_interrupt) const;

  const GrinderClient& client_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace grinder
