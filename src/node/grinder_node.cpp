#include "node/grinder_node.h"

#include "flute_grinder/MachineInfo.h"
#include "flute_grinder/base/await.h"
#include "node/crash_guard.h"
#include "node/node_files.h"

#include <boost/algorithm/string/trim.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

namespace grinder {

namespace {

constexpr std::chrono::seconds kStopTimeout(10);
constexpr std::chrono::seconds kGoalEndTimeout(2);
constexpr std::chrono::seconds kLoopEndTimeout(1);
constexpr std::chrono::milliseconds kEndLook(2);
constexpr double kRounding = 1e-9;  ///< rounding of a period that is the inverse of a rate

/// Refuses a drive whose capabilities are not finite, that cannot keep the control period, or that buffers more than
/// the loop keeps.
/// @param drive type of the drive. @param rate name of the parameter.
void checkCapabilities(const DriveCapabilities& can, const std::string& drive, const std::string& rate, double period) {
  std::ostringstream text;
  // With fewer digits a refused rate might look like the allowed one.
  text.precision(std::numeric_limits<double>::digits10);
  if (!(can.shortest_period >= 0 && std::isfinite(can.shortest_period))) {
    text << "the drive " << drive << " states a shortest_period of " << can.shortest_period << " s; allowed: 0 or more";
  } else if (!(can.shortest_period <= period * (1 + kRounding))) {
    text << "parameter " << rate << " = " << 1 / period << "; allowed: up to " << 1 / can.shortest_period
         << ", which the drive " << drive << " can hold";
  } else if (can.buffer > kMaxCommandsWaiting) {
    text << "the drive " << drive << " buffers " << can.buffer << " commands; allowed: up to " << kMaxCommandsWaiting;
  }
  if (!text.str().empty()) throw ParameterError(text.str());
}

flute_grinder::MachineInfo toMessage(const MachineInfo& info, const DriveCapabilities& can, double jog_timeout) {
  const auto copy = [](const Axes& axes, auto& array) {
    std::copy(axes.data(), axes.data() + kAxisCount, array.begin());
  };
  flute_grinder::MachineInfo message;
  message.name = info.name;
  message.version = info.version;
  message.drive = info.drive;
  message.homing = can.homing;
  message.spindle = can.spindle;
  message.coolant = can.coolant;
  message.probe = can.probe;
  message.swivel = can.swivel;
  message.buffer = can.buffer;
  message.period = info.period;
  message.jog_timeout = jog_timeout;
  copy(info.max_velocity, message.max_velocity);
  copy(info.max_acceleration, message.max_acceleration);
  copy(info.max_following_error, message.max_following_error);
  return message;
}

}  // namespace

GrinderNode::GrinderNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, DrivePlugin& plugin)
    : nh_(nh), private_nh_(private_nh) {
  std::string urdf;
  if (!nh_.getParam("robot_description", urdf)) {
    throw ParameterError("parameter " + nh_.resolveName("robot_description") + " is missing; allowed: a URDF");
  }
  const ParameterReader parameters(private_nh_);
  const MachineModel model(urdf);
  const MachineConfig own = readMachineConfig(model, parameters, plugin.declared());
  const LoopConfig& config = own.loop;
  const std::string name = private_nh_.getNamespace();
  const NodeFiles files = readNodeFiles(parameters, name);
  const Tolerances tolerances = readTolerances(files.tolerances);
  journal_ = std::make_unique<Journal>(files.journal, name);
  offsets_ = std::make_unique<OffsetStore>(files.offsets, name);
  const std::string unknown = offsets_->unknown();
  if (!unknown.empty()) ROS_ERROR_STREAM(unknown << "; until then no job starts");
  const Journal::Status journal = journal_->status();
  if (!journal.error.empty()) {
    ROS_ERROR_STREAM(journal.error << "; the last job cannot be continued, and the wheel may be in the work");
  }
  history_ = std::make_unique<History>(files.history, own.history_limit);
  plugin.load(own.drive, parameters);
  Drive& drive = plugin.drive();
  ros::NodeHandle hardware_nh(private_nh_, "hardware");
  plugin.call("init()", [&] { drive.init(private_nh_, hardware_nh); });
  const bool is_cup = offsets_->offsets().wheel.rim > 0;
  const Wheel wheel = journal.error.empty() ? journal.on_disk.wheel : unknownWheel(config.machine.limits, is_cup);
  plugin.call("capabilities()", [&] { loop_ = std::make_unique<ControlLoop>(drive, config, wheel); });
  const DriveCapabilities& can = loop_->capabilities();
  checkCapabilities(can, own.drive, parameters.name("control_rate"), config.machine.period);
  const MachineInfo machine = machineInfo(config, own.drive);
  const auto configuration = private_nh_.param<std::string>("configuration", "of the parameter server");
  ROS_INFO_STREAM("machine " << machine.name << ", drive " << machine.drive << ", configuration "
                             << boost::algorithm::trim_copy(configuration));
  machine_ = private_nh_.advertise<flute_grinder::MachineInfo>("machine", 1, true);
  machine_.publish(toMessage(machine, can, config.jog_timeout));
  planner_ = std::make_unique<Planner>(config.machine, MachineShapes(model));
  telemetry_ = std::make_unique<Telemetry>(nh_, private_nh_, *loop_, *journal_, *offsets_, *history_, tolerances,
                                           machine, own.thresholds, model, own.first_view);
  stops_ = std::make_unique<StopServer>(private_nh_, *loop_, gate_);
  loop_->startThread();
  watchdog_ = std::make_unique<LoopWatchdog>(*loop_, drive);
  stopAxesOnCrash(*loop_);
  if (!journal.on_disk.finished) loop_->setFeedOverride(journal.on_disk.feed_override);
  telemetry_->start(*watchdog_);
  offset_server_ = std::make_unique<OffsetServer>(private_nh_, *loop_, gate_, *offsets_,
                                                  offsetLimits(config.machine.limits, own.offset_change_limit));
  requests_ = std::make_unique<RequestServer>(private_nh_, *loop_, gate_, *offset_server_);
  probes_ = std::make_unique<ProbeServer>(private_nh_, *loop_, gate_, *offset_server_);
  goals_ = std::make_unique<GoalServer>(private_nh_, *loop_, gate_, *stops_, *planner_, *telemetry_, *journal_,
                                        *offset_server_, *watchdog_);
}

GrinderNode::~GrinderNode() { endCrashGuard(); }

std::string GrinderNode::shutDown() {
  gate_.shut();
  loop_->postStop(MachineEvent::kDisable);
  const auto or_hangs = [this](bool done) { return done || watchdog_->loopHangs(); };
  await(kStopTimeout, kEndLook, [&] { return or_hangs(!isPowered(loop_->status().state)); });
  await(kGoalEndTimeout, kEndLook, [&] { return or_hangs(!goals_->busy()); });
  // The markers in rviz must not outlive the node.
  telemetry_->clearScene();
  planner_->end();
  loop_->requestEnd();
  await(kLoopEndTimeout, kEndLook, [this] { return hangingFunction().empty(); });
  const std::string hanging = hangingFunction();
  if (hanging.empty()) loop_->stopThread();
  return hanging;
}

/// The function of the drive that hangs, after the loop was told to end; empty if none.
std::string GrinderNode::hangingFunction() const {
  if (loop_->isPoweringOff()) return "powerOff()";
  if (!loop_->hasEnded()) return "read(), write() or wait()";
  return loop_->isPreparing() ? "prepare()" : "";
}

}  // namespace grinder
