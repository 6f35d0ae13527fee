#include "drive/hal_hardware.h"

#include "drive/hal_parameters.h"
#include "flute_grinder/drive/export_drive.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>

namespace grinder {

namespace {

constexpr int kResetCycles = 100;    ///< length of the reset pulse, so every servo cycle and drive sees it
constexpr int kNapsPerCycle = 4;     ///< checks of the FIFO per period
constexpr int kMaxWait = 10;         ///< periods after which a cycle starts even if HAL plays nothing
constexpr double kRateError = 1e-3;  ///< relative difference allowed between HAL's thread and the control loop

void nap(std::int64_t nanoseconds) {
  const timespec time{0, static_cast<long>(nanoseconds)};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &time, nullptr);
}

}  // namespace

bool HalHardware::init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) {
  const HalParameters parameters = readHalParameters(ParameterReader(root_nh), ParameterReader(robot_hw_nh));
  buffer_ = parameters.buffer;
  component_ = std::make_unique<HalComponent>(parameters.component);
  fifo_ = std::make_unique<HalFifo>(component_->id(), parameters.streamer, 2 * buffer_);
  makePins();
  checkServoThread(parameters.control_rate);
  return true;
}

void HalHardware::makePins() {
  pins_ = static_cast<Pins*>(component_->allocate(sizeof(Pins)));
  Pins& pins = *pins_;
  HalComponent& c = *component_;
  for (std::size_t i = 0; i < pins.joints.size(); ++i) {
    Pins::Joint& joint = pins.joints[i];
    const std::string axis = std::string("axis-") + "xyza"[i] + '-';
    c.addPin(axis + "feedback", HAL_IN, joint.feedback, true);
    c.addPin(axis + "velocity", HAL_IN, joint.velocity, true);
    c.addPin(axis + "fault", HAL_IN, joint.fault, true);
    c.addPin(axis + "homed", HAL_IN, joint.homed, true);
    c.addPin(axis + "enable", HAL_OUT, joint.enable, false);
    c.addPin(axis + "command", HAL_OUT, joint.command, false);
  }
  c.addPin("enabled", HAL_IN, pins.enabled, true);
  c.addPin("emergency-stop", HAL_IN, pins.emergency_stop, true);
  c.addPin("homing", HAL_IN, pins.homing, true);
  c.addPin("spindle-at-speed", HAL_IN, pins.spindle_at_speed, true);
  c.addPin("coolant-on", HAL_IN, pins.coolant_on, true);
  c.addPin("probe-free", HAL_IN, pins.probe_free, true);
  status_.has_probe = c.addPin("probe-contact", HAL_IN, pins.probe_contact, false);
  has_swivel_ = c.addPin("swivel", HAL_IN, pins.swivel, false);
  c.addPin("servo-cycles", HAL_IN, pins.servo_cycles, true);
  c.addPin("servo-rate", HAL_IN, pins.servo_rate, true);
  c.addPin("played", HAL_IN, pins.played, true);
  c.addPin("underruns", HAL_IN, pins.underruns, true);
  c.addPin("enable", HAL_OUT, pins.enable, true);
  c.addPin("heartbeat", HAL_OUT, pins.heartbeat, true);
  c.addPin("fault-reset", HAL_OUT, pins.fault_reset, false);
  c.addPin("home", HAL_OUT, pins.home, false);
  c.addPin("spindle-run", HAL_OUT, pins.spindle_run, false);
  c.addPin("coolant-run", HAL_OUT, pins.coolant_run, false);
  component_->ready();
}

void HalHardware::checkServoThread(double control_rate) const {
  // Each servo cycle plays one command; at any other rate the axes would move faster or slower than planned.
  const double rate = *pins_->servo_rate;
  if (std::abs(rate - control_rate) <= kRateError * control_rate) return;
  std::ostringstream text;
  text << "HAL's servo thread runs at " << rate
       << " Hz (0 if it was not started); allowed: control_rate = " << control_rate << " Hz";
  throw ParameterError(text.str());
}

void HalHardware::read(const ros::Time&, const ros::Duration&) {
  // Read before the other pins: whatever has just switched the power off is then visible in them.
  status_.enabled = *pins_->enabled;
  status_.emergency_stop = *pins_->emergency_stop;
  status_.underruns = static_cast<std::uint32_t>(*pins_->underruns);
  status_.commands_waiting = waiting();
  status_.spindle_at_speed = *pins_->spindle_at_speed;
  status_.coolant_on = *pins_->coolant_on;
  status_.probe_free = *pins_->probe_free;
  if (status_.has_probe) status_.probe_contact = *pins_->probe_contact;
  if (has_swivel_) status_.swivel = *pins_->swivel;
  readJoints();
  readHoming();
  const double servo_cycles = *pins_->servo_cycles;
  if (servo_cycles != servo_cycles_) ++status_.feedback_count;
  servo_cycles_ = servo_cycles;
}

void HalHardware::readJoints() {
  status_.fault = overflow_;
  status_.fault_text = overflow_ ? "the FIFO of commands is full" : "";
  status_.homed = true;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const Pins::Joint& joint = pins_->joints[i];
    position_[i] = *joint.feedback;
    velocity_[i] = *joint.velocity;
    if (*joint.fault && !status_.fault) {
      status_.fault = true;
      status_.fault_text = "of the amplifier of ";
      status_.fault_text += kJointNames[i];
    }
    status_.homed = status_.homed && *joint.homed;
  }
}

void HalHardware::readHoming() {
  const bool homing = *pins_->homing;
  if (homing_ && !homing) {
    // Queued commands refer to the old reference: they must leave the FIFO before commands take effect again.
    settling_ = true;
    settled_ = sent_ + 1;
  }
  homing_ = homing;
  if (settling_ && static_cast<std::int32_t>(*pins_->played - settled_) >= 0) settling_ = false;
  status_.homing = homing || (settling_ && status_.enabled);
}

void HalHardware::write(const ros::Time&, const ros::Duration&) {
  writeSwitches();
  if (!drive_command_.enable) {
    switchOff();
  } else if (!*pins_->enable) {
    switchOn();
  } else if (status_.enabled) {
    send();
  }
}

void HalHardware::writeSwitches() {
  *pins_->heartbeat = !*pins_->heartbeat;
  if (drive_command_.reset) {
    reset_cycles_ = kResetCycles;
    overflow_ = false;
  }
  *pins_->fault_reset = reset_cycles_ > 0;
  if (reset_cycles_ > 0) --reset_cycles_;
  *pins_->home = drive_command_.home;
  *pins_->spindle_run = drive_command_.spindle;
  *pins_->coolant_run = drive_command_.coolant;
  for (std::size_t i = 0; i < command_.size(); ++i) {
    *pins_->joints[i].command = command_[i];
    *pins_->joints[i].enable = drive_command_.enable;
  }
}

bool HalHardware::powerOff() {
  *pins_->enable = false;
  return true;
}

void HalHardware::switchOff() {
  *pins_->enable = false;
  if (*pins_->enabled) return;  // the streamer may still be reading
  fifo_->drain();
  sent_ = *pins_->played;
  settling_ = false;
}

void HalHardware::switchOn() {
  if (*pins_->enabled) return;  // HAL has not switched off yet
  // The first commands are queued before power comes on, because the streamer's pins still have the values at which a
  // job was aborted.
  fifo_->drain();
  sent_ = *pins_->played;
  for (std::uint32_t i = 0; i < buffer_; ++i) send();
  *pins_->enable = true;
}

void HalHardware::send() {
  Axes command;
  std::copy(command_.begin(), command_.end(), command.data());
  if (fifo_->push(command, sent_ + 1)) {
    ++sent_;
  } else {
    overflow_ = true;
  }
}

ros::Duration HalHardware::wait(const ros::Duration& period) {
  if (!*pins_->enabled || !*pins_->enable) return RobotHW::wait(period);
  const std::int64_t time = period.toNSec() / kNapsPerCycle;
  for (int naps = 0; naps < kNapsPerCycle * kMaxWait; ++naps) {
    if (waiting() < buffer_ || !*pins_->enabled) break;
    nap(time);
  }
  return sinceLastCycle(period);
}

}  // namespace grinder

FLUTE_GRINDER_EXPORT_DRIVE(grinder::HalHardware)
