#include "flute_grinder/operator/online.h"

#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/core/units.h"
#include "flute_grinder/drive/machine_state.h"
#include "flute_grinder/operator/interrupt.h"
#include "flute_grinder/operator/json_output.h"
#include "flute_grinder/operator/state_watch.h"

#include <actionlib_msgs/GoalID.h>
#include <std_srvs/Trigger.h>

#include <cstdio>

namespace flute_grinder {

namespace {

void printProgress(const JobProgress& progress) {
  if (progress.job_digest.empty()) return;
  std::printf("last job        %.12s, ", progress.job_digest.c_str());
  if (progress.finished) {
    std::printf("finished\n");
  } else {
    std::printf("tooth %d, pass %d not finished, X %.3f mm\n", progress.tooth + 1, progress.pass + 1,
                progress.x / units::kMillimetre);
  }
}

/// Switches the power off, which is what ends homing. @return the exit status.
int breakOffHoming(const std::string& node) {
  if (const int status = callTrigger(node, "disable")) return status;
  return fail("homing was broken off; the power is off");
}

}  // namespace

int fail(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  return 1;
}

int noGrinder(const ros::NodeHandle& nh) { return fail("no grinder answers as " + nh.getNamespace()); }

bool awaitMaster() {
  if (await(kPatience, [] { return ros::master::check(); })) return true;
  fail("no ROS master answers at " + ros::master::getURI());
  return false;
}

int printStatus(const std::string& node, bool json) {
  ros::NodeHandle nh(node);
  const auto state = ros::topic::waitForMessage<GrinderState>("state", nh, ros::Duration(kPatience.toSec()));
  if (!state) return noGrinder(nh);
  if (json) {
    print(toJson(*state));
    return 0;
  }
  std::printf("state           %s\n", state->state_name.c_str());
  std::printf("enabled         %s\n", state->enabled ? "yes" : "no");
  std::printf("homed           %s\n", state->homed ? "yes" : "no");
  std::printf("spindle         %s\n", state->spindle_at_speed ? "at speed" : "not at speed");
  std::printf("coolant         %s\n", state->coolant_on ? "on" : "off");
  std::printf("emergency stop  %s\n", state->emergency_stop ? "pressed" : "released");
  std::printf("feed            %.1f mm/min, override %.0f %%\n", state->feed / units::kMillimetrePerMinute,
              state->override * 100);
  if (inJob(*state)) {
    std::printf("tooth, pass     %d, %d\n", state->tooth + 1, state->pass + 1);
  }
  if (!state->hold_reason.empty()) std::printf("held because    %s\n", state->hold_reason.c_str());
  if (!state->fault.empty()) std::printf("fault           %s\n", state->fault.c_str());
  printProgress(state->progress);
  return 0;
}

int callTrigger(const std::string& node, const std::string& service) {
  ros::NodeHandle nh(node);
  ros::ServiceClient client = nh.serviceClient<std_srvs::Trigger>(service);
  std_srvs::Trigger call;
  if (!await(kPatience, [&] { return client.exists(); }) || !client.call(call)) return noGrinder(nh);
  return call.response.success ? 0 : fail(call.response.message);
}

int home(const std::string& node) {
  ros::NodeHandle nh(node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const StateWatch watch(nh);
  if (!watch.begin()) return noGrinder(nh);
  catchInterrupts();
  if (const int status = callTrigger(node, "home")) return status;
  // Among the first are some of before the call.
  const bool renewed = watch.renew();
  while (renewed && watch.newest().state == GrinderState::HOMING && !watch.lost()) {
    if (interrupts() > 0) return breakOffHoming(node);
    ros::WallDuration(0.02).sleep();
  }
  if (!renewed || watch.lost()) return fail(kLinkLost);
  const GrinderState state = watch.newest();
  if (state.homed) return 0;
  return fail(state.fault.empty() ? "homing was broken off" : state.fault);
}

int cancelJob(const std::string& node) {
  ros::NodeHandle nh(node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const StateWatch watch(nh);
  ros::Publisher cancel = nh.advertise<actionlib_msgs::GoalID>("grind/cancel", 1);
  if (!watch.begin() || !await(kPatience, [&] { return cancel.getNumSubscribers() > 0; })) return noGrinder(nh);
  const GrinderState before = watch.newest();
  if (!inJob(before)) {
    return fail("cancel refused: the machine is in state " + before.state_name +
                "; allowed: " + allowedIn(static_cast<MachineState>(before.state)));
  }
  cancel.publish(actionlib_msgs::GoalID());  // one that names no goal is for all
  while (inJob(watch.newest()) && !watch.lost()) ros::WallDuration(0.02).sleep();
  if (watch.lost()) return fail(kLinkLost);
  const GrinderState state = watch.newest();
  return state.fault.empty() ? 0 : fail(state.fault);
}

int setFeedOverride(const std::string& node, double percent) {
  ros::NodeHandle nh(node);
  ros::ServiceClient client = nh.serviceClient<SetFeedOverride>("set_feed_override");
  SetFeedOverride call;
  call.request.fraction = percent / 100;
  if (!await(kPatience, [&] { return client.exists(); }) || !client.call(call)) return noGrinder(nh);
  return call.response.success ? 0 : fail(call.response.message);
}

}  // namespace flute_grinder
