#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/fault_text.h"
#include "flute_grinder/control/realtime.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/network/init_ros.h"
#include "flute_grinder/network/master_watch.h"
#include "flute_grinder/network/own_address.h"
#include "flute_grinder/network/ros_api.h"
#include "flute_grinder/network/start_ros.h"
#include "node/drive_plugin.h"
#include "node/end_signals.h"
#include "node/grinder_node.h"
#include "node/output.h"

#include <ros/network.h>
#include <ros/ros.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace {

constexpr std::chrono::milliseconds kLook{100};

/// Waits for the ROS master. roscpp would wait by itself when it is started, but a signal could not end that wait.
/// @return false if a signal has ended the wait.
bool waitForMaster(const grinder::EndSignals& signals) {
  const std::atomic<bool> never{false};
  for (bool warned = false; !grinder::callRosApi(ros::master::getHost(), ros::master::getPort(), "getPid", {}, never);
       warned = true) {
    if (!warned) ROS_WARN_STREAM("no ROS master answers at " << ros::master::getURI() << "; waiting for one");
    if (signals.await(kLook)) return false;
  }
  return true;
}

/// The address of a running node of the same name, which the master would end for this one; empty if none answers.
std::string runningNode() {
  const std::atomic<bool> never{false};
  const auto uri = grinder::callRosApi(ros::master::getHost(), ros::master::getPort(), "lookupNode",
                                       {ros::this_node::getName()}, never);
  std::string host;
  std::uint32_t port = 0;
  if (!uri || uri->getType() != XmlRpc::XmlRpcValue::TypeString) return "";
  std::string address = XmlRpc::XmlRpcValue(*uri);
  if (!ros::network::splitURI(address, host, port)) return "";
  return grinder::callRosApi(host, port, "getPid", {}, never) ? address : "";
}

/// Waits for a signal that ends the program, or until ROS is shut down by other means.
void waitForEnd(const grinder::EndSignals& signals) {
  while (ros::ok() && !signals.await(kLook)) {
  }
}

/// The names of the services of the node and its drive.
std::vector<std::string> services() {
  std::vector<std::string> names{"~set_feed_override", "~confirm_swivel", "~confirm_wheel", "~reclamped",
                                 "~jog_step",          "~set_offsets",    "~touch_off",     "~hardware/inject_fault"};
  for (const grinder::EventRow& request : grinder::kMachineEvents) {
    if (request.service) names.push_back(std::string("~") + request.service);
  }
  for (std::string& name : names) name = ros::names::resolve(name);
  return names;
}

/// Serves the drive's callbacks, for which its init() may wait; all others have their own threads.
class DriveCallbacks {
 public:
  DriveCallbacks() { spinner_.start(); }
  ~DriveCallbacks() {
    const grinder::EndInTime guard("a callback of the drive");
    spinner_.stop();
  }

 private:
  ros::AsyncSpinner spinner_{1};
};

/// @return the exit status.
int run(const ros::NodeHandle& nh, const grinder::EndSignals& signals) {
  // Destroyed last, so that an error is logged even if the drive's destructor hangs.
  grinder::DrivePlugin plugin(signals);
  try {
    const DriveCallbacks callbacks;
    grinder::GrinderNode node(nh, ros::NodeHandle("~"), plugin);
    grinder::boundAddressSpace();
    const grinder::MasterWatch master_watch(services());
    waitForEnd(signals);
    const std::string hanging = node.shutDown();
    if (hanging.empty()) return 0;
    ROS_FATAL_STREAM("the process ends without the return of the drive's " << hanging);
    std::_Exit(1);
  } catch (const std::exception& error) {
    // The text may come from drives and files.
    ROS_FATAL_STREAM(grinder::escaped(grinder::textOrNone(error), "\n"));
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const grinder::EndSignals signals;
  grinder::dropBlockedOutput();
  grinder::boundThreadStacks();

  try {
    grinder::initRos(argc, argv, "grinder", ros::init_options::NoSigintHandler);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", grinder::escaped(error.what()).c_str());
    return 2;
  }
  const std::string refusal = grinder::ownAddressRefusal();
  if (!refusal.empty()) {
    ROS_FATAL_STREAM(refusal);
    return 1;
  }
  if (!waitForMaster(signals)) return 0;
  const std::string other = runningNode();
  if (!other.empty()) {
    ROS_FATAL_STREAM("a node " << ros::this_node::getName() << " runs already, at " << other
                               << "; allowed: one by each name");
    return 1;
  }
  const ros::ServiceServer loggers = grinder::startRos();
  const int status = run(ros::NodeHandle(), signals);
  ros::shutdown();
  return status;
}
