#include "drive/ros_control_drive.h"

#include "flute_grinder/drive/export_drive.h"
#include "flute_grinder/drive/parameters.h"

#include <std_msgs/Bool.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace grinder {

namespace {

namespace hi = hardware_interface;
using Clock = SignalInput::Clock;

constexpr std::chrono::milliseconds kPowerOff{200};  ///< longest wait for the power's service
constexpr std::chrono::milliseconds kPoll{1};
/// Of a command that a RobotHW limits to what it just reaches [m], A [rad].
constexpr double kRounding = 1e-9;

/// Calls a service again and again, by a connection that survives the ROS master.
template <typename Service>
class ServiceCaller {
 public:
  /// @throw ros::InvalidNameException
  ServiceCaller(const ros::NodeHandle& nh, const std::string& name) : nh_(nh), name_(nh.resolveName(name)) {}

  /// @return whether it was done; if not, the log says why.
  bool call(Service service) {
    if (!client_.isValid()) client_ = nh_.serviceClient<Service>(name_, true);
    if (!client_.call(service)) {
      ROS_ERROR_STREAM_THROTTLE(1, "the service " << name_ << " does not answer");
    } else if (!service.response.success) {
      ROS_ERROR_STREAM_THROTTLE(1, "the service " << name_ << " has refused: " << service.response.message);
    } else {
      return true;
    }
    return false;
  }

 private:
  ros::NodeHandle nh_;
  std::string name_;
  ros::ServiceClient client_;
};

/// An on and off, as std_msgs/Bool or std_srvs/SetBool.
void connectSwitch(std::optional<CommandOutput>& output, const CommandSink& sink, ros::NodeHandle& nh) {
  if (!sink.topic.empty()) {
    const ros::Publisher publisher = nh.advertise<std_msgs::Bool>(sink.topic, 1, true);
    output.emplace([publisher](bool on) {
      std_msgs::Bool message;
      message.data = on;
      publisher.publish(message);
      return true;
    });
  } else if (!sink.service.empty()) {
    const auto caller = std::make_shared<ServiceCaller<std_srvs::SetBool>>(nh, sink.service);
    output.emplace([caller](bool on) {
      std_srvs::SetBool request;
      request.request.data = on;
      return caller->call(request);
    });
  }
}

/// A request without an off.
void connectTrigger(std::optional<CommandOutput>& output, const CommandSink& sink, ros::NodeHandle& nh) {
  if (!sink) return;
  const auto caller = std::make_shared<ServiceCaller<std_srvs::Trigger>>(nh, sink.service);
  output.emplace([caller](bool on) { return !on || caller->call({}); });
}

template <typename Interface>
bool has(hi::RobotHW& robot_hw, const std::array<std::string, kAxisCount>& names) {
  const auto* interface = robot_hw.get<Interface>();
  if (!interface) return false;
  const std::vector<std::string> offered = interface->getNames();
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return std::find(offered.begin(), offered.end(), name) != offered.end();
  });
}

template <typename Interface>
Interface& require(hi::RobotHW& robot_hw) {
  if (auto* interface = robot_hw.get<Interface>()) return *interface;
  throw ParameterError("the RobotHW offers no " + hi::internal::demangledTypeName<Interface>());
}

}  // namespace

// ---------------------------------------------------------------------------------------------------------------------
// Initialisation

void RosControlDrive::init(ros::NodeHandle&, ros::NodeHandle& drive_nh) {
  const RosControlParameters parameters = readRosControlParameters(ParameterReader(drive_nh));
  read_is_clock_ = parameters.read_is_clock;
  loadRobotHw(parameters.robot_hw, drive_nh);
  takeJoints(parameters.joints);
  connect(parameters);
}

void RosControlDrive::loadRobotHw(const std::string& type, ros::NodeHandle& drive_nh) {
  const std::string parameter = "parameter " + drive_nh.getNamespace() + "/robot_hw/type = " + type;
  try {
    // Where the package hardware_interface is not found, this throws.
    loader_ =
        std::make_unique<pluginlib::ClassLoader<hi::RobotHW>>("hardware_interface", "hardware_interface::RobotHW");
    robot_hw_ = loader_->createUniqueInstance(type);
  } catch (const pluginlib::PluginlibException& error) {
    throw ParameterError(parameter + " cannot be loaded: " + error.what());
  }
  ros::NodeHandle robot_hw_nh(drive_nh, "robot_hw");
  if (!robot_hw_->init(nh_, robot_hw_nh)) throw ParameterError(parameter + ": its init() has returned false");
}

void RosControlDrive::takeJoints(const std::array<std::string, kAxisCount>& names) {
  auto& states = require<hi::JointStateInterface>(*robot_hw_);
  const bool with_velocity = has<hi::PosVelJointInterface>(*robot_hw_, names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    joints_[i].state = states.getHandle(names[i]);
    if (with_velocity) {
      joints_[i].with_velocity = require<hi::PosVelJointInterface>(*robot_hw_).getHandle(names[i]);
    } else {
      joints_[i].position = require<hi::PositionJointInterface>(*robot_hw_).getHandle(names[i]);
    }
  }
  hi::ControllerInfo info;
  info.name = "flute_grinder";
  info.type = "flute_grinder/RosControlDrive";
  info.claimed_resources.emplace_back(with_velocity ? hi::internal::demangledTypeName<hi::PosVelJointInterface>()
                                                    : hi::internal::demangledTypeName<hi::PositionJointInterface>(),
                                      std::set<std::string>(names.begin(), names.end()));
  controller_ = {info};
  if (robot_hw_->checkForConflict(controller_)) {
    throw ParameterError("the RobotHW finds its four joints in conflict with one another");
  }
}

void RosControlDrive::connect(const RosControlParameters& parameters) {
  const auto& s = parameters.signals;
  const double timeout = parameters.signal_timeout;
  listen(signals_.emergency_stop, s.emergency_stop, true, timeout);
  listen(signals_.homed, s.homed, false, timeout);
  listen(signals_.spindle_at_speed, s.spindle_at_speed, false, timeout);
  listen(signals_.coolant_on, s.coolant_on, false, timeout);
  listen(signals_.enabled, s.enabled, false, timeout);
  listen(signals_.fault, s.fault, true, timeout);
  listen(signals_.probe_free, s.probe_free, false, timeout);
  listen(signals_.probe_contact, s.probe_contact, true, timeout);
  connectSwitch(commands_.power, parameters.commands.power, nh_);
  connectSwitch(commands_.spindle, parameters.commands.spindle, nh_);
  connectSwitch(commands_.coolant, parameters.commands.coolant, nh_);
  connectTrigger(commands_.home, parameters.commands.home, nh_);
  connectTrigger(commands_.reset, parameters.commands.reset, nh_);
}

void RosControlDrive::listen(std::optional<SignalInput>& input, const std::string& source, bool safe, double timeout) {
  input.emplace(source, safe, timeout);
  if (input->topic().empty()) return;
  const boost::function<void(const std_msgs::Bool::ConstPtr&)> take =
      [&input](const std_msgs::Bool::ConstPtr& message) { input->receive(message->data != 0, Clock::now()); };
  subscribers_.push_back(
      nh_.subscribe<std_msgs::Bool>(input->topic(), 1, take, {}, ros::TransportHints().tcpNoDelay()));
}

DriveCapabilities RosControlDrive::capabilities() const {
  DriveCapabilities can;
  can.homing = commands_.home.has_value();
  can.spindle = commands_.spindle.has_value();
  can.coolant = commands_.coolant.has_value();
  can.probe = !signals_.probe_contact->topic().empty();
  can.prepares = true;
  return can;
}

void RosControlDrive::prepare() {
  if (!robot_hw_->prepareSwitch(controller_, none_)) {
    throw std::runtime_error("the RobotHW refuses to switch to the grinder's commands");
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// The cycle

void RosControlDrive::read(const DriveCycle& cycle, DriveFeedback& feedback) {
  // First, because it must not depend on what the RobotHW may throw.
  readStatus(feedback.status);
  readFault(feedback.status);
  robot_hw_->read(cycle.time, cycle.period);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    feedback.position[i] = joints_[i].state.getPosition();
    feedback.velocity[i] = joints_[i].state.getVelocity();
  }
  ++feedback.status.feedback_count;
}

void RosControlDrive::readStatus(DriveStatus& status) {
  const Clock::time_point now = Clock::now();
  status.emergency_stop = signals_.emergency_stop->at(now);
  status.enabled = mode_.isOn() && !power_off_ && signals_.enabled->at(now);
  status.homed = signals_.homed->at(now);
  status.homing = sent_.home && commands_.home && !commands_.home->isOn() && !commands_.home->hasFailed();
  status.spindle_at_speed = signals_.spindle_at_speed->at(now);
  status.coolant_on = signals_.coolant_on->at(now);
  status.probe_free = signals_.probe_free->at(now);
  status.probe_contact = signals_.probe_contact->at(now);
  status.fault = signals_.fault->at(now);
  status.fault_text = "";
}

void RosControlDrive::readFault(DriveStatus& status) {
  if (changed_axis_ < kAxisCount) {
    status.fault_text = "the RobotHW has changed the command of ";
    status.fault_text += kJointNames[static_cast<std::size_t>(changed_axis_)];
  } else if (mode_.isRefused()) {
    status.fault_text = "the RobotHW has failed to switch to the grinder's commands";
  } else if (sent_.enable && commands_.power && commands_.power->hasFailed()) {
    status.fault_text = "the service that switches the power on has refused; see the log";
  } else {
    return;
  }
  status.fault = true;
}

void RosControlDrive::write(const DriveCycle& cycle, const DriveCommand& command) {
  if (!command.enable) power_off_ = false;
  if (command.reset) changed_axis_ = kAxisCount;
  passOn(command);
  const bool powered = command.enable && !power_off_ && (!commands_.power || commands_.power->isOn());
  mode_.update(powered, *this);
  commandJoints(cycle, command);
  sent_ = command;
}

void RosControlDrive::passOn(const DriveCommand& command) {
  if (commands_.power) commands_.power->set(command.enable && !power_off_);
  if (commands_.spindle) commands_.spindle->set(command.spindle);
  if (commands_.coolant) commands_.coolant->set(command.coolant);
  if (commands_.home) commands_.home->set(command.home);
  // On for one cycle: the next one takes it back, which is nothing to the service.
  if (commands_.reset) commands_.reset->set(command.reset);
}

void RosControlDrive::commandJoints(const DriveCycle& cycle, const DriveCommand& command) {
  const double period = cycle.nominal.toSec();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].command(command.position[i], (command.position[i] - sent_.position[i]) / period);
  }
  robot_hw_->write(cycle.time, cycle.nominal);
  if (!mode_.isOn() || changed_axis_ < kAxisCount) return;
  for (int i = 0; i < kAxisCount; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    if (!(std::abs(joints_[axis].commanded() - command.position[axis]) <= kRounding)) changed_axis_ = i;
  }
}

void RosControlDrive::Joint::command(double at, double velocity) {
  if (with_velocity) {
    with_velocity->setCommand(at, velocity);
  } else {
    position.setCommand(at);
  }
}

double RosControlDrive::Joint::commanded() const {
  return with_velocity ? with_velocity->getCommandPosition() : position.getCommand();
}

ros::Duration RosControlDrive::wait(const ros::Duration& nominal) {
  return read_is_clock_ ? sinceLastCycle(nominal) : Drive::wait(nominal);
}

bool RosControlDrive::powerOff() {
  power_off_ = true;
  if (!commands_.power) return false;
  commands_.power->set(false);
  const auto deadline = Clock::now() + kPowerOff;
  while (!commands_.power->isOff() && Clock::now() < deadline) std::this_thread::sleep_for(kPoll);
  return commands_.power->isOff();
}

void RosControlDrive::doSwitch(bool on) {
  if (on) {
    robot_hw_->doSwitch(controller_, none_);
  } else {
    robot_hw_->doSwitch(none_, controller_);
  }
}

ModeSwitch::Result RosControlDrive::switchResult() const {
  switch (robot_hw_->switchResult(controller_.front())) {
    case hi::RobotHW::SwitchState::DONE: return ModeSwitch::Result::kDone;
    case hi::RobotHW::SwitchState::ONGOING: return ModeSwitch::Result::kOngoing;
    default: return ModeSwitch::Result::kError;
  }
}

}  // namespace grinder

FLUTE_GRINDER_EXPORT_DRIVE(grinder::RosControlDrive)
