#include "cli/online.h"

#include "cli/call.h"
#include "cli/interrupt.h"
#include "cli/json_output.h"
#include "cli/last_job.h"
#include "cli/stop_keys.h"
#include "cli/waiting.h"
#include "flute_grinder/ConfirmSwivel.h"
#include "flute_grinder/SetFeedOverride.h"
#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/client/grinder_client.h"
#include "flute_grinder/client/latest.h"
#include "flute_grinder/client/requests.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/messages/continue_job.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/messages/wheel_known.h"
#include "flute_grinder/network/prompt_connections.h"

#include <actionlib_msgs/GoalID.h>
#include <ros/service_manager.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace grinder {

namespace {

const ros::WallDuration kSettling(1);    ///< longest time for an axis to stand still after a jog
const ros::WallDuration kQuiet(1);       ///< time without a message while the ROS master does not answer
const ros::WallDuration kFreshness(1);   ///< longest wait for the present state, once the last one is known
constexpr double kJogTolerance = 10e-6;  ///< distance within which a jog has reached its end [m], A [rad]

/// Whether a cancel is allowed in a state.
bool takesCancel(const flute_grinder::GrinderState& state) {
  return after(static_cast<MachineState>(state.state), MachineEvent::kCancel).has_value();
}

int noMaster() {
  return fail("no ROS master answers at " + ros::master::getURI() + "; launch the grinder, or correct ROS_MASTER_URI");
}

/// The other grinders that the ROS master knows, for the error that one does not answer: "; ...", or empty.
std::string otherGrinders(const std::string& node) {
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  std::string others;
  for (const ros::master::TopicInfo& topic : topics) {
    const std::string other = ros::names::parentNamespace(topic.name);
    if (topic.datatype != ros::message_traits::datatype<flute_grinder::GrinderState>() || other == node) continue;
    others += (others.empty() ? "" : ", ") + other;
  }
  return others.empty() ? "" : "; the ROS master knows " + others + ": name one with --node";
}

int noNode(const std::string& node) { return fail("no grinder answers as " + node + otherGrinders(node)); }

/// Whether the ROS master knows a grinder's node, which may still be starting, or a publisher of its state.
bool isKnown(const std::string& node) {
  XmlRpc::XmlRpcValue arguments, response, payload;
  arguments[0] = ros::this_node::getName();
  arguments[1] = node;
  if (ros::master::execute("lookupNode", arguments, response, payload, false)) return true;
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  const auto is_state = [&](const ros::master::TopicInfo& topic) { return topic.name == node + "/state"; };
  return std::any_of(topics.begin(), topics.end(), is_state);
}

/// Whether the ROS master knows only its own log: it was just started, and nodes that outlived the previous master have
/// not registered yet.
bool isNew() {
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  const auto is_log = [](const ros::master::TopicInfo& topic) { return topic.name.rfind("/rosout", 0) == 0; };
  return std::all_of(topics.begin(), topics.end(), is_log);
}

/// @param text text from a peer, printed escaped.
void printLine(const char* name, const std::string& text) { std::printf("%-15s %s\n", name, escaped(text).c_str()); }

void printPosition(const char* name, const boost::array<double, kAxisCount>& axes) {
  const auto shown = [&](int axis) {
    return fixed(axes[static_cast<std::size_t>(axis)] / shopScale(unitOf(axis, 0)), 3);
  };
  std::printf("%-15s X %s, Y %s, Z %s mm, A %s deg\n", name, shown(kX).c_str(), shown(kY).c_str(), shown(kZ).c_str(),
              shown(kA).c_str());
}

std::string swivelText(const flute_grinder::GrinderState& state) {
  if (std::isnan(state.swivel)) return "not confirmed";
  return text(Quantity{state.swivel, Unit::kRadian}) + (state.swivel_measured ? ", measured" : ", confirmed");
}

std::string wheelInWork(const flute_grinder::GrinderState& state) {
  if (!state.wheel_in_work) return "no";
  return std::string(isWheelUnknown(state) ? "not known" : "yes") +
         (state.wheel_backs_off ? "; off along X first" : "");
}

/// Prints the bases of the work offsets. @param offsets null if unknown.
void printZeroPoints(const flute_grinder::WorkOffsets::ConstPtr& offsets) {
  const WorkOffsets all = offsets ? fromMessage(*offsets) : WorkOffsets();
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const std::string basis = basisText(axis, all.axes[static_cast<std::size_t>(axis)]);
    printLine(format("zero point %c", axisLetter(axis)).c_str(), offsets ? basis : "not known");
  }
  printLine("wheel", offsets ? mountedText(all.wheel) : "not known");
  printLine("tool", offsets ? toolText(all.tool) : "not known");
}

/// @param node resolved name. @param offsets null if unknown.
void printState(const std::string& node, const flute_grinder::GrinderState& state,
                const flute_grinder::WorkOffsets::ConstPtr& offsets) {
  printLine("grinder", node);
  printLine("state", state.state_name);
  std::printf("enabled         %s\n", state.power_stays_on ? "yes, though it was switched off"
                                      : state.enabled      ? "yes"
                                                           : "no");
  std::printf("homed           %s\n", state.homed ? "yes" : "no");
  std::printf("spindle         %s\n", state.spindle_at_speed    ? "at speed"
                                      : state.spindle_commanded ? "on, not at speed"
                                                                : "not at speed");
  std::printf("coolant         %s\n", state.coolant_on ? "on" : "off");
  std::printf("emergency stop  %s\n", state.emergency_stop ? "pressed" : "released");
  std::printf("wheel in work   %s\n", wheelInWork(state).c_str());
  std::printf("swivel          %s\n", swivelText(state).c_str());
  printPosition("work position", state.work_position);
  printPosition("of the machine", state.position);
  if (!(Axes(state.distance_to_go.data()) == 0).all()) printPosition("to go", state.distance_to_go);
  printZeroPoints(offsets);
  std::printf("feed            %.1f mm/min, override %.0f %%\n", state.feed / units::kMillimetrePerMinute,
              state.override * 100);
  if (inJob(state)) std::printf("tooth, pass     %d, %d\n", state.tooth + 1, state.pass + 1);
  if (!state.hold_reason.empty()) printLine("held because", state.hold_reason);
  if (!state.fault.empty()) printLine("fault", state.fault);
  if (!state.journal_error.empty()) printLine("no journal", state.journal_error);
  if (state.progress.job_digest.empty()) return;
  printLine("last job", lastJob(state.progress));
  if (!inJob(state)) printLine("it ended", endText(state.progress));
}

/// Waits until the machine leaves the state of a motion that was started.
/// @param status exit status of the start; after a failure nothing is awaited.
/// @param moves whether the motion continues in a given state.
/// @param wait_more called meanwhile; returns false to stop waiting.
/// @return the exit status of the start, or of a lost connection.
int awaitMotion(int status, const States& states, const std::function<bool(std::uint8_t)>& moves,
                const std::function<bool()>& wait_more) {
  if (status != 0) return status;
  bool connected = awaitNext(states);
  while (connected && moves(states.newest()->state) && wait_more()) {
    ros::WallDuration(0.02).sleep();
    connected = !isLost(states);
  }
  return connected ? 0 : fail(kLinkLost);
}

}  // namespace

int fail(const std::string& text) {
  std::fprintf(stderr, "%s\n", escaped(text, "\n").c_str());
  return 1;
}

int succeed(const std::string& text) {
  std::printf("%s\n", escaped(text, "\n").c_str());
  return 0;
}

int noGrinder(const ros::NodeHandle& nh) {
  if (!ros::master::check()) return noMaster();
  return noNode(nh.getNamespace());
}

bool joinRos(const std::string& node) {
  if (!await(kQuiet, ros::master::check)) {
    std::fprintf(stderr, "no ROS master answers at %s; waiting for one\n", ros::master::getURI().c_str());
    if (!await(kMasterPatience - kQuiet, ros::master::check)) {
      noMaster();
      return false;
    }
  }
  const std::string name = ros::names::resolve(node);
  if (!isKnown(name) && !(isNew() && await(kMasterPatience, [&] { return isKnown(name); }))) {
    noNode(name);
    return false;
  }
  // Called here, so that the end of the last NodeHandle does not call ros::shutdown(), which takes 0.1 to 0.3 s.
  connectPromptly();
  ros::start();
  // Never stopped, because that would wait for its thread; it ends with the process.
  static ros::AsyncSpinner spinner(1);
  spinner.start();
  return true;
}

void leaveRos() {
  for (const int signal : {SIGINT, SIGTSTP}) std::signal(signal, SIG_DFL);  // a master may hang
  // Topics are unregistered by their owners. The services are the ones of every roscpp node.
  if (ros::isStarted()) ros::ServiceManager::instance()->shutdown();
}

int printStatus(const std::string& node, bool json) {
  ros::NodeHandle nh(node);
  const States states(nh, "state");
  const Latest<flute_grinder::WorkOffsets> offsets(nh, "offsets");
  if (!await(kPatience, [&] { return states.count() > 0; })) return noGrinder(nh);
  // A limited wait: the last known state is better than none.
  await(kFreshness, [&] { return states.count() > 1 && offsets.newest(); });
  if (json) {
    print(toJson(nh.getNamespace(), *states.newest(), offsets.newest()));
  } else {
    printState(nh.getNamespace(), *states.newest(), offsets.newest());
  }
  return 0;
}

namespace {

/// The success message of a request that is answered when it is done or has begun.
std::string doneText(MachineEvent event) {
  switch (event) {
    case MachineEvent::kEnable: return "the power is on";
    case MachineEvent::kReset: return "the fault is reset; the power is commanded off";
    default: return toString(event) + std::string(": done");
  }
}

/// Waits until homing is over; Ctrl-C breaks it off by switching the power off.
int home(const std::string& node) {
  ros::NodeHandle nh(node);
  const States states(nh, "state");
  if (!await(kPatience, [&] { return states.count() > 0; })) return noGrinder(nh);
  catchInterrupts();
  const int status = awaitMotion(
      call<std_srvs::Trigger>(nh, serviceOf(MachineEvent::kHome), {}), states,
      [](std::uint8_t state) { return state == flute_grinder::GrinderState::HOMING; },
      [] { return interrupts() == 0; });
  if (status != 0) return status;
  const flute_grinder::GrinderState state = *states.newest();
  if (state.state == flute_grinder::GrinderState::HOMING) {
    // Homing ends only by switching the power off.
    const int refused = call<std_srvs::Trigger>(nh, serviceOf(MachineEvent::kDisable), {});
    return refused != 0 ? refused : fail("homing was aborted; the power is off");
  }
  if (state.homed) return succeed("homed");
  return fail(state.fault.empty() ? "homing was aborted" : state.fault);
}

/// Whether a motion can be followed and held. It does not wait for the client's other topics.
bool canStop(const GrinderClient& client) { return client.states().newest() && client.stopsConnected(); }

/// Waits until the wheel is lifted; Ctrl-C and Ctrl-Z hold it.
int lift(const std::string& node) {
  ros::NodeHandle nh(node);
  const GrinderClient client(node);
  StopKeys keys(client);
  if (!await(kPatience, [&] { return canStop(client); })) return noGrinder(nh);
  catchInterrupts();
  catchHolds();
  keys.start([&] { client.stopNow(MachineEvent::kHold); });
  const int status = awaitMotion(
      call<std_srvs::Trigger>(nh, serviceOf(MachineEvent::kLift), {}), client.states(),
      [](std::uint8_t state) { return state == flute_grinder::GrinderState::LIFTING; }, [] { return true; });
  if (status != 0) return status;
  const flute_grinder::GrinderState state = *client.states().newest();
  if (state.state == flute_grinder::GrinderState::FAULT) return fail(state.fault);
  if (!state.wheel_in_work) return 0;
  return fail("the lift was stopped: the wheel is still in the work; 'grind lift' lifts it");
}

/// Cancels the running job of any client, and waits for the end. Without a GrinderClient: a stop is to wait for no
/// topic but its own.
int cancelJob(const std::string& node) {
  ros::NodeHandle nh(node);
  const States states(nh, "state");
  ros::Publisher cancel = nh.advertise<actionlib_msgs::GoalID>("grind/cancel", 1);
  if (!await(kPatience, [&] { return states.newest() && cancel.getNumSubscribers() > 0; })) return noGrinder(nh);
  const flute_grinder::GrinderState before = *states.newest();
  // Sent in any state, because the state does not show a job in planning. An empty id cancels every goal.
  cancel.publish(actionlib_msgs::GoalID());
  if (!takesCancel(before)) {
    return fail("cancel refused: the machine is in state " + before.state_name + "; allowed: " +
                allowedIn(static_cast<MachineState>(before.state)) + "; a job that was being planned is canceled");
  }
  while (takesCancel(*states.newest())) {
    if (isLost(states)) return fail(kLinkLost);
    ros::WallDuration(0.02).sleep();
  }
  const flute_grinder::GrinderState state = *states.newest();
  return state.fault.empty() ? 0 : fail(state.fault);
}

constexpr int kSettled = 5;          ///< positions without motion after which an axis stands still
constexpr double kEncoder = 0.5e-6;  ///< change of the position of an axis at rest [m], A [rad]

/// Waits until an axis stands still, but not for long. @return its position; NaN if none is received.
double settledPosition(const GrinderClient& client, int axis) {
  double last = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t seen = 0;
  int still = 0;
  await(kSettling, [&] {
    const std::optional<Axes> position = client.view().position;
    if (!position || std::exchange(seen, client.joints().count()) == seen) return false;
    const double before = std::exchange(last, (*position)[axis]);
    still = std::abs(last - before) <= kEncoder ? still + 1 : 0;
    return still >= kSettled;
  });
  return last;
}

}  // namespace

int jog(const std::string& node, int axis, double distance, double feed) {
  const double unit = shopScale(unitOf(axis, 0));
  ros::NodeHandle nh(node);
  const GrinderClient client(node);
  StopKeys keys(client);
  std::optional<Axes> begin;
  if (!await(kPatience, [&] { return canStop(client) && (begin = client.view().position); })) return noGrinder(nh);
  catchInterrupts();
  catchHolds();
  keys.start([&] { client.stopNow(MachineEvent::kHold); });
  const double end = (*begin)[axis] + distance * unit;
  const auto request = jogRequest(axis, distance * unit, feed * unit / 60);
  const auto moves = [](std::uint8_t state) {
    return state == flute_grinder::GrinderState::JOGGING || state == flute_grinder::GrinderState::JOGGING_RETRACTED;
  };
  const int status =
      awaitMotion(call<flute_grinder::JogStep>(nh, "jog_step", request), client.states(), moves, [] { return true; });
  if (status != 0) return status;
  const flute_grinder::GrinderState state = *client.states().newest();
  if (state.state == flute_grinder::GrinderState::FAULT) return fail(state.fault);
  const double there = settledPosition(client, axis);
  if (!std::isfinite(there)) return fail(kLinkLost);
  std::printf("%c %s %s\n", axisLetter(axis), fixed(there / unit, 4).c_str(), shopUnit(unitOf(axis, 0)));
  return std::abs(there - end) <= kJogTolerance ? 0 : fail("the jog was stopped before its end");
}

int request(const std::string& node, MachineEvent event) {
  switch (event) {
    case MachineEvent::kHome: return home(node);
    case MachineEvent::kLift: return lift(node);
    case MachineEvent::kCancel: return cancelJob(node);
    default: break;
  }
  ros::NodeHandle nh(node);
  const int status = call<std_srvs::Trigger>(nh, serviceOf(event), {});
  return status != 0 ? status : succeed(doneText(event));
}

int confirmSwivel(const std::string& node, double degrees) {
  ros::NodeHandle nh(node);
  flute_grinder::ConfirmSwivel::Request request;
  request.swivel = degrees * units::kDegree;
  const int status = call<flute_grinder::ConfirmSwivel>(nh, "confirm_swivel", request);
  if (status != 0) return status;
  return succeed("the swivel is confirmed at " + text(Quantity{request.swivel, Unit::kRadian}));
}

int setFeedOverride(const std::string& node, double percent) {
  ros::NodeHandle nh(node);
  flute_grinder::SetFeedOverride::Request request;
  request.fraction = percent / 100;
  return call<flute_grinder::SetFeedOverride>(nh, "set_feed_override", request);
}

}  // namespace grinder
