#include "flute_grinder/cli/online.h"

#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/cli/interrupt.h"
#include "flute_grinder/cli/json_output.h"
#include "flute_grinder/cli/last_job.h"
#include "flute_grinder/cli/state_watch.h"
#include "flute_grinder/cli/stop_keys.h"
#include "flute_grinder/connection/service_call.h"
#include "flute_grinder/core/machine_state.h"
#include "flute_grinder/core/units.h"
#include "flute_grinder/messages/reasons.h"

#include <actionlib_msgs/GoalID.h>
#include <std_srvs/Trigger.h>

#include <cstdio>
#include <functional>
#include <optional>

namespace flute_grinder {

namespace {

/// Whether there is something to cancel.
bool takesCancel(const GrinderState& state) {
  return after(static_cast<MachineState>(state.state), MachineEvent::kCancel).has_value();
}

int noMaster() { return fail("no ROS master answers at " + ros::master::getURI()); }

/// Calls a service of the grinder, and prints why if it is refused or not answered. @return the exit status.
template <typename Service>
int call(ros::NodeHandle& nh, const std::string& service, const typename Service::Request& request) {
  ros::ServiceClient there = nh.serviceClient<Service>(service);
  if (!await(kPatience, [&] { return there.exists(); })) return noGrinder(nh);
  std::optional<typename Service::Response> response;
  ServiceCall running(nh.resolveName(service), ros::service_traits::md5sum<Service>(),
                      ros::serialization::serializeMessage(request), kPatience,
                      [&](ros::SerializedMessage* answer) { response = responseFrom<Service>(answer); });
  await(kPatience, [&] { return running.finished(); });
  running.end();
  if (!response) {
    return fail(service + ": no answer from the grinder " + nh.getNamespace() +
                "; the request may or may not have been carried out");
  }
  return response->success ? 0 : fail(response->message);
}

void printState(const GrinderState& state) {
  std::printf("state           %s\n", state.state_name.c_str());
  std::printf("enabled         %s\n", state.enabled ? "yes" : "no");
  std::printf("homed           %s\n", state.homed ? "yes" : "no");
  std::printf("spindle         %s\n", state.spindle_at_speed ? "at speed" : "not at speed");
  std::printf("coolant         %s\n", state.coolant_on ? "on" : "off");
  std::printf("emergency stop  %s\n", state.emergency_stop ? "pressed" : "released");
  std::printf("wheel in work   %s\n", state.wheel_in_work ? "yes" : "no");
  std::printf("feed            %.1f mm/min, override %.0f %%\n", state.feed / units::kMillimetrePerMinute,
              state.override * 100);
  if (inJob(state)) std::printf("tooth, pass     %d, %d\n", state.tooth + 1, state.pass + 1);
  if (!state.hold_reason.empty()) std::printf("held because    %s\n", state.hold_reason.c_str());
  if (!state.fault.empty()) std::printf("fault           %s\n", faultText(state).c_str());
  if (!state.progress.job_digest.empty()) std::printf("last job        %s\n", lastJob(state.progress).c_str());
}

/// Starts a motion by a service, and waits until the machine leaves the motion's state.
/// @param wait_more called meanwhile; returns false to stop waiting.
/// @return the exit status of the start, or of a lost connection.
int runMotion(ros::NodeHandle& nh, const StateWatch& watch, const std::string& service, std::uint8_t state,
              const std::function<bool()>& wait_more) {
  if (const int status = call<std_srvs::Trigger>(nh, service, {})) return status;
  bool connected = watch.awaitNext();
  while (connected && watch.newest().state == state && wait_more()) {
    ros::WallDuration(0.02).sleep();
    connected = !watch.lost();
  }
  return connected ? 0 : fail(kLinkLost);
}

}  // namespace

int fail(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  return 1;
}

int noGrinder(const ros::NodeHandle& nh) {
  if (!ros::master::check()) return noMaster();
  if (!ros::Time::isValid()) return fail("/use_sim_time is set, but no time comes on /clock");
  return fail("no grinder answers as " + nh.getNamespace());
}

bool awaitMaster() {
  if (await(kPatience, [] { return ros::master::check(); })) return true;
  noMaster();
  return false;
}

int printStatus(const std::string& node, bool json) {
  ros::NodeHandle nh(node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const StateWatch watch(nh);
  if (!await(kPatience, [&] { return watch.begun(); })) return noGrinder(nh);
  if (json) {
    print(toJson(watch.newest()));
  } else {
    printState(watch.newest());
  }
  return 0;
}

namespace {

/// Waits until homing is over; Ctrl-C breaks it off by switching the power off.
int home(const std::string& node) {
  ros::NodeHandle nh(node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const StateWatch watch(nh);
  if (!await(kPatience, [&] { return watch.begun(); })) return noGrinder(nh);
  catchInterrupts();
  const int status =
      runMotion(nh, watch, serviceOf(MachineEvent::kHome), GrinderState::HOMING, [] { return interrupts() == 0; });
  if (status != 0) return status;
  const GrinderState state = watch.newest();
  if (state.state == GrinderState::HOMING) {
    // Homing ends only by switching the power off.
    const int refused = call<std_srvs::Trigger>(nh, serviceOf(MachineEvent::kDisable), {});
    return refused != 0 ? refused : fail("homing was aborted; the power is off");
  }
  if (state.homed) return 0;
  return fail(state.fault.empty() ? "homing was aborted" : faultText(state));
}

/// Waits until the wheel is lifted; Ctrl-C and Ctrl-Z hold it.
int lift(const std::string& node) {
  ros::NodeHandle nh(node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const StateWatch watch(nh);
  StopKeys keys(nh, watch);
  if (!await(kPatience, [&] { return watch.begun() && keys.connected(); })) return noGrinder(nh);
  catchInterrupts();
  catchHolds();
  keys.start([&] { keys.hold(); });
  const int status = runMotion(nh, watch, serviceOf(MachineEvent::kLift), GrinderState::LIFTING, [] { return true; });
  if (status != 0) return status;
  const GrinderState state = watch.newest();
  if (state.state == GrinderState::FAULT) return fail(state.fault);
  if (!state.wheel_in_work) return 0;
  return fail("the lift was stopped: the wheel is still in the work; 'grind lift' lifts it");
}

/// Cancels the running job, whoever started it, and waits for the end.
int cancelJob(const std::string& node) {
  ros::NodeHandle nh(node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const StateWatch watch(nh);
  ros::Publisher cancel = nh.advertise<actionlib_msgs::GoalID>("grind/cancel", 1);
  if (!await(kPatience, [&] { return watch.begun() && cancel.getNumSubscribers() > 0; })) return noGrinder(nh);
  const GrinderState before = watch.newest();
  // In any state, since a job may be in planning, which the state does not show. An empty id cancels every goal.
  cancel.publish(actionlib_msgs::GoalID());
  if (!takesCancel(before)) {
    return fail("cancel refused: the machine is in state " + before.state_name + "; allowed: " +
                allowedIn(static_cast<MachineState>(before.state)) + "; a job that was being planned is canceled");
  }
  while (takesCancel(watch.newest()) && !watch.lost()) ros::WallDuration(0.02).sleep();
  if (watch.lost()) return fail(kLinkLost);
  const GrinderState state = watch.newest();
  return state.fault.empty() ? 0 : fail(state.fault);
}

}  // namespace

int request(const std::string& node, MachineEvent event) {
  switch (event) {
    case MachineEvent::kHome: return home(node);
    case MachineEvent::kLift: return lift(node);
    case MachineEvent::kCancel: return cancelJob(node);
    default: break;
  }
  ros::NodeHandle nh(node);
  return call<std_srvs::Trigger>(nh, serviceOf(event), {});
}

int setFeedOverride(const std::string& node, double percent) {
  ros::NodeHandle nh(node);
  SetFeedOverride::Request request;
  request.fraction = percent / 100;
  return call<SetFeedOverride>(nh, "set_feed_override", request);
}

}  // namespace flute_grinder
