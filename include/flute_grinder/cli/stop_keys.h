#pragma once

#include "flute_grinder/cli/state_watch.h"

#include <ros/ros.h>

#include <atomic>
#include <functional>
#include <thread>

namespace flute_grinder {

/// The keys that stop a motion: Ctrl-C does what its command says, Ctrl-Z holds on the path. They are looked after in a
/// thread of their own, so that no word that waits for the terminal holds up a stop, and by a topic, whose connection
/// outlives the master.
class StopKeys {
 public:
  /// @param nh the grinder's namespace.
  /// @param watch of the same grinder; must outlive this.
  StopKeys(ros::NodeHandle& nh, const StateWatch& watch);
  StopKeys(const StopKeys&) = delete;
  StopKeys& operator=(const StopKeys&) = delete;
  ~StopKeys();

  /// Whether the grinder would hear a hold.
  bool connected() const { return publisher_.getNumSubscribers() > 0; }
  /// Has the grinder hold on the path. Thread safe.
  void hold() const;
  /// Looks after the keys, of which those that came since they are caught count too.
  /// @param on_interrupt called in the keys' thread, after each Ctrl-C.
  void start(std::function<void()> on_interrupt);

 private:
  void follow(const std::function<void()>& on_interrupt) const;

  const StateWatch& watch_;
  ros::Publisher publisher_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace flute_grinder
