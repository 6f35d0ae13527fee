#include "drive/ros_control_drive.h"

#include "flute_grinder/drive/export_drive.h"
#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/network/service_call.h"

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
#include <utility>
#include <vector>

namespace grinder {

namespace {

namespace hi = hardware_interface;
using Clock = SignalInput::Clock;

constexpr std::chrono::milliseconds kPowerOff{200};  ///< longest wait for the power's service
constexpr std::chrono::milliseconds kPoll{1};
constexpr double kSwitchTimeout = 2;    ///< longest wait for the answer of a service that switches [s]
constexpr double kHomingTimeout = 1e5;  ///< practically none: the machine's homing_timeout applies [s]
constexpr double kFast = 0.7;           ///< length below which a cycle comes too soon [periods]
constexpr int kMostFast = 100;          ///< cycles in a row that may come too soon
constexpr int kMostUnused = 100;        ///< cycles after prepare() without a command for power until a stop is prepared
/// Change of a command at a limit that counts as rounding by the RobotHW [m], A [rad].
constexpr double kRounding = 1e-9;

/// Calls a service, and gives up when the call is no longer wanted or after a timeout; failures are logged.
/// @param timeout [s]. @return whether the service has succeeded.
template <typename Service>
bool call(const std::string& name, const typename Service::Request& request, double timeout,
          const std::function<bool()>& still_wanted) {
  std::optional<typename Service::Response> response;
  ServiceCall call(name, ros::service_traits::MD5Sum<Service>::value(), ros::serialization::serializeMessage(request),
                   ros::WallDuration(timeout),
                   [&](ros::SerializedMessage* answer) { response = responseFrom<Service>(answer); });
  while (!call.finished() && still_wanted()) {
    std::this_thread::sleep_for(kPoll);
    call.abortIfOverdue();
  }
  call.end();
  if (!response) {
    ROS_ERROR_STREAM_THROTTLE(1, "the service " << name << " does not answer");
  } else if (!response->success) {
    ROS_ERROR_STREAM_THROTTLE(1, "the service " << name << " has refused: " << response->message);
  }
  return response && response->success;
}

/// Connects an output that switches on and off, as std_msgs/Bool or std_srvs/SetBool. @throw ros::InvalidNameException
void connectSwitch(std::optional<SwitchOutput>& output, const CommandSink& sink, ros::NodeHandle& nh) {
  if (!sink.topic.empty()) {
    const ros::Publisher publisher = nh.advertise<std_msgs::Bool>(sink.topic, 1, true);
    output.emplace([publisher](bool on, const std::function<bool()>&) {
      std_msgs::Bool message;
      message.data = on;
      publisher.publish(message);
      // A later subscriber gets the latched message.
      return publisher.getNumSubscribers() > 0;
    });
  } else if (!sink.service.empty()) {
    output.emplace([name = nh.resolveName(sink.service)](bool on, const std::function<bool()>& still_wanted) {
      std_srvs::SetBool::Request request;
      request.data = on;
      return call<std_srvs::SetBool>(name, request, kSwitchTimeout, still_wanted);
    });
  }
}

/// Connects an output for a request that cannot be switched off. @param timeout [s]. @throw ros::InvalidNameException
void connectTrigger(std::optional<TriggerOutput>& output, const CommandSink& sink, ros::NodeHandle& nh,
                    double timeout) {
  if (!sink) return;
  output.emplace([name = nh.resolveName(sink.service), timeout](const std::function<bool()>& still_wanted) {
    return call<std_srvs::Trigger>(name, {}, timeout, still_wanted);
  });
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
    // Throws if the package hardware_interface is not found.
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
  connectTrigger(commands_.home, parameters.commands.home, nh_, kHomingTimeout);
  connectTrigger(commands_.reset, parameters.commands.reset, nh_, kSwitchTimeout);
  // A stop is prepared too, as by controller_manager; some RobotHW stop only then.
  stop_.emplace([this](const std::function<bool()>&) {
    const std::lock_guard<std::mutex> lock(prepare_mutex_);
    prepared_ = false;
    robot_hw_->prepareSwitch(none_, controller_);
    return true;
  });
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
  // A stop after this preparation would undo it.
  while (stop_->isBusy()) std::this_thread::sleep_for(kPoll);
  prepared_ = false;
  const std::lock_guard<std::mutex> lock(prepare_mutex_);
  const bool ready = robot_hw_->prepareSwitch(controller_, none_);
  prepared_ = true;
  if (!ready) throw std::runtime_error("the RobotHW refuses to switch to the grinder's commands");
}

// ---------------------------------------------------------------------------------------------------------------------
// The cycle

void RosControlDrive::read(const DriveCycle& cycle, DriveFeedback& feedback) {
  // The status first, because the RobotHW may throw.
  readStatus(feedback.status);
  readFault(feedback.status);
  read_returned_ = false;
  robot_hw_->read(cycle.time, cycle.period);
  read_returned_ = true;
  // read() may have hung, and powerOff() may have been called meanwhile.
  feedback.status.enabled = feedback.status.enabled && !power_off_;
  if (fast_ <= kMostFast) fast_ = cycle.period < cycle.nominal * kFast ? fast_ + 1 : 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    feedback.position[i] = joints_[i].state.getPosition();
    feedback.velocity[i] = joints_[i].state.getVelocity();
  }
  ++feedback.status.feedback_count;
}

void RosControlDrive::readStatus(DriveStatus& status) {
  const Clock::time_point now = Clock::now();
  status.emergency_stop = signals_.emergency_stop->at(now);
  // Without the mode the axes do not follow, but power that is commanded off may still be on.
  const bool may_stay =
      !sent_.enable && commands_.power && (!signals_.enabled->topic().empty() || commands_.power->hasFailed());
  status.enabled = (mode_.isOn() || may_stay) && !power_off_ && signals_.enabled->at(now);
  status.homed = signals_.homed->at(now);
  // Homing is reported in at least one reading, however soon the service answers. The answer may overtake the topic of
  // `homed`.
  status.homing = sent_.home && commands_.home &&
                  (commands_.home->isBusy() || !homing_seen_ || !(status.homed || commands_.home->hasFailed()));
  homing_seen_ = sent_.home;
  // `always` means: as soon as the spindle is commanded. A wheel that always turned would forbid probing.
  status.spindle_at_speed =
      signals_.spindle_at_speed->at(now) && (sent_.spindle || !signals_.spindle_at_speed->topic().empty());
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
  } else if (commands_.power && commands_.power->hasFailed()) {
    status.fault_text = "the power cannot be switched; see the log";
  } else if (sent_.home && commands_.home && !status.homing && commands_.home->hasFailed()) {
    status.fault_text = "the homing service has failed; see the log";
  } else if (fast_ > kMostFast) {
    status.fault_text = "read() returns sooner than control_rate allows";
  } else {
    return;
  }
  status.fault = true;
}

void RosControlDrive::write(const DriveCycle& cycle, const DriveCommand& command) {
  if (!command.enable) power_off_ = false;
  if (command.reset) {
    changed_axis_ = kAxisCount;
    fast_ = 0;
  }
  passOn(command);
  const DriveCommand last = std::exchange(sent_, command);
  used_ = used_ || command.enable;
  const bool powered = command.enable && !power_off_ && (!commands_.power || commands_.power->isOn());
  const bool was_on = mode_.isOn();
  mode_.update(powered, *this);
  if (!powered) prepareStop();
  // During homing the commands follow the positions.
  commandJoints(cycle, last, was_on && mode_.isOn() && !command.home && !last.home);
}

void RosControlDrive::prepareStop() {
  if (std::exchange(stopping_, stop_->isBusy()) && !stopping_) doSwitch(false);
  if (!prepared_) unused_ = 0;
  if (sent_.enable || !prepared_ || stopping_) return;
  // Power follows the preparation at once, unless the request was withdrawn meanwhile.
  if (!used_ && ++unused_ < kMostUnused) return;
  stop_->fire();
  stopping_ = true;
  used_ = false;
  unused_ = 0;
}

void RosControlDrive::passOn(const DriveCommand& command) {
  if (commands_.power) commands_.power->set(command.enable && !power_off_);
  if (commands_.spindle) commands_.spindle->set(command.spindle);
  if (commands_.coolant) commands_.coolant->set(command.coolant);
  if (commands_.home && command.home && !sent_.home) commands_.home->fire();
  if (commands_.home && !command.home && sent_.home) commands_.home->giveUp();
  if (commands_.reset && command.reset) commands_.reset->fire();
}

/// @param moves both this command and the one before reach the axes.
void RosControlDrive::commandJoints(const DriveCycle& cycle, const DriveCommand& last, bool moves) {
  const double period = cycle.nominal.toSec();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double velocity = moves ? (sent_.position[i] - last.position[i]) / period : 0;
    joints_[i].command(sent_.position[i], velocity);
  }
  robot_hw_->write(cycle.time, cycle.nominal);
  if (!mode_.isOn() || changed_axis_ < kAxisCount) return;
  for (int i = 0; i < kAxisCount; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    if (!(std::abs(joints_[axis].commanded() - sent_.position[axis]) <= kRounding)) changed_axis_ = i;
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
  const bool read_paces = read_is_clock_ && read_returned_ && fast_ <= kMostFast;
  return read_paces ? sinceLastCycle(nominal) : Drive::wait(nominal);
}

bool RosControlDrive::powerOff() {
  power_off_ = true;
  if (commands_.spindle) commands_.spindle->set(false);
  if (commands_.coolant) commands_.coolant->set(false);
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
