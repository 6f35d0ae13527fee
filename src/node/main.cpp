#include "flute_grinder/connection/master_watch.h"
#include "flute_grinder/control/realtime.h"
#include "flute_grinder/core/machine_state.h"
#include "flute_grinder/node/grinder_node.h"
#include "flute_grinder/node/output.h"

#include <ros/ros.h>

#include <csignal>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

namespace {

/// Waits for a signal that ends the program, or until ROS is shut down by other means.
void waitForEnd(const sigset_t& signals) {
  const timespec interval{0, 100'000'000};
  while (ros::ok()) {
    if (sigtimedwait(&signals, nullptr, &interval) > 0) return;
  }
}

/// Of the node and its drive.
std::vector<std::string> services() {
  std::vector<std::string> names{
      "~set_feed_override", "~confirm_swivel",       "~jog_step", "~plan", "~probe", "~set_offset",
      "~touch_off",         "~hardware/inject_fault"};
  for (const flute_grinder::EventRow& request : flute_grinder::kMachineEvents) {
    if (request.service) names.push_back(std::string("~") + request.service);
  }
  for (std::string& name : names) name = ros::names::resolve(name);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  // Blocked in every thread, because the machine must come to rest before the process ends.
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  flute_grinder::dropBlockedOutput();
  flute_grinder::boundThreadStacks();

  ros::init(argc, argv, "grinder", ros::init_options::NoSigintHandler);
  // Keeps ROS running to the end, so that errors are still logged.
  const ros::NodeHandle nh;
  // With /use_sim_time, use the system clock until the first /clock message arrives.
  ros::Time::init();
  try {
    flute_grinder::GrinderNode node(nh, ros::NodeHandle("~"));
    const flute_grinder::MasterWatch master_watch(services());
    ros::AsyncSpinner spinner(1);  // for the drive's callbacks; all others have their own threads
    spinner.start();
    waitForEnd(signals);
    node.shutDown();
    spinner.stop();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  ros::shutdown();
  return 0;
}
