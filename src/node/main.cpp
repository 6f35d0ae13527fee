#include "flute_grinder/node/grinder_node.h"
#include "flute_grinder/node/master_watch.h"

#include <ros/ros.h>

#include <csignal>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

namespace {

/// Waits for SIGINT or SIGTERM, or for ROS to be shut down from elsewhere.
void waitForEnd(const sigset_t& signals) {
  const timespec interval{0, 100'000'000};
  while (ros::ok()) {
    if (sigtimedwait(&signals, nullptr, &interval) > 0) return;
  }
}

/// Of the node and its drive.
std::vector<std::string> services() {
  std::vector<std::string> names;
  for (const char* name : {"enable", "disable", "home", "hold", "resume", "retract", "lift", "reset_fault",
                           "set_feed_override", "plan", "hardware/inject_fault"}) {
    names.push_back(ros::names::resolve(std::string("~") + name));
  }
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  // Blocked in every thread: the machine must come to rest before the process ends.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  ros::init(argc, argv, "grinder", ros::init_options::NoSigintHandler);
  // Keeps ROS up to the end, for the log of what went wrong too.
  const ros::NodeHandle nh;
  try {
    flute_grinder::GrinderNode node(nh, ros::NodeHandle("~"));
    const flute_grinder::MasterWatch master_watch(services());
    ros::AsyncSpinner spinner(4);
    spinner.start();
    waitForEnd(signals);
    node.shutDown();
    spinner.stop();
    ros::shutdown();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
