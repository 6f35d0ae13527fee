#pragma once

#include "cli/state_watch.h"

#include <ros/ros.h>

#include <atomic>
#include <functional>
#include <thread>

namespace grinder {

/// The keys that stop a motion: the command defines what Ctrl-C does, Ctrl-Z holds on the path. They are handled in
/// their own thread, so that a blocked terminal cannot delay a stop, and use a topic, whose connection survives the
/// master.
class StopKeys {
 public:
  /// @param nh the grinder's namespace.
  /// @param watch watch of the same grinder; must outlive this object.
  StopKeys(ros::NodeHandle& nh, const StateWatch& watch);
  ~StopKeys();

  /// Whether the grinder is connected, so that it would receive a hold.
  bool connected() const { return publisher_.getNumSubscribers() > 0; }
  /// Makes the grinder hold on the path. Thread safe.
  void hold() const;
  /// Starts handling the keys, including any pressed since catchInterrupts() and catchHolds().
  /// @param on_interrupt called in the keys' thread, after each Ctrl-C.
  void start(std::function<void()> on_interrupt);

 private:
  void run(const std::function<void()>& on_interrupt) const;

  const StateWatch& watch_;
  ros::Publisher publisher_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace grinder
