#include "drive/hal_hardware.h"

#include "drive/hal_parameters.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/drive/export_drive.h"

#include <cmath>
#include <ctime>

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

void HalHardware::init(ros::NodeHandle& node_nh, ros::NodeHandle& drive_nh) {
  const HalParameters parameters = readHalParameters(ParameterReader(node_nh), ParameterReader(drive_nh));
  kept_ = parameters.buffer;
  can_.buffer = 2 * kept_;
  component_ = std::make_unique<HalComponent>(parameters.component);
  fifo_ = std::make_unique<HalFifo>(component_->id(), parameters.streamer, can_.buffer);
  makePins();
  sent_ = *pins_->played;
  checkServoThread(parameters.control_rate);
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
  can_.probe = c.addPin("probe-contact", HAL_IN, pins.probe_contact, false);
  can_.swivel = c.addPin("swivel", HAL_IN, pins.swivel, false);
  c.addPin("servo-cycles", HAL_IN, pins.servo_cycles, true);
  c.addPin("servo-rate", HAL_IN, pins.servo_rate, true);
  c.addPin("played", HAL_IN, pins.played, true);
  c.addPin("underruns", HAL_IN, pins.underruns, true);
  c.addPin("enable", HAL_OUT, pins.enable, true);
  c.addPin("heartbeat", HAL_OUT, pins.heartbeat, true);
  c.addPin("fault-reset", HAL_OUT, pins.fault_reset, false);
  can_.homing = c.addPin("home", HAL_OUT, pins.home, false);
  can_.spindle = c.addPin("spindle-run", HAL_OUT, pins.spindle_run, false);
  can_.coolant = c.addPin("coolant-run", HAL_OUT, pins.coolant_run, false);
  component_->ready();
}

void HalHardware::checkServoThread(double control_rate) const {
  // Each servo cycle plays one command; at any other rate the axes would move faster or slower than planned.
  const double rate = *pins_->servo_rate;
  if (std::abs(rate - control_rate) <= kRateError * control_rate) return;
  throw ParameterError(format(
      "HAL's servo thread runs at %g Hz (0 if it was not started); allowed: control_rate = %g Hz", rate, control_rate));
}

void HalHardware::read(const DriveCycle&, DriveFeedback& feedback) {
  DriveStatus& status = feedback.status;
  // Read before the other pins: whatever has just switched the power off is then visible in them.
  enabled_ = *pins_->enabled;
  status.enabled = enabled_ && !power_off_;
  status.emergency_stop = *pins_->emergency_stop;
  status.underruns = static_cast<std::uint32_t>(*pins_->underruns);
  status.commands_waiting = waiting();
  status.spindle_at_speed = *pins_->spindle_at_speed;
  status.coolant_on = *pins_->coolant_on;
  status.probe_free = *pins_->probe_free;
  if (can_.probe) status.probe_contact = *pins_->probe_contact;
  if (can_.swivel) status.swivel = *pins_->swivel;
  readJoints(feedback);
  readHoming(status);
  const double servo_cycles = *pins_->servo_cycles;
  if (servo_cycles != servo_cycles_) ++status.feedback_count;
  servo_cycles_ = servo_cycles;
}

void HalHardware::readJoints(DriveFeedback& feedback) const {
  DriveStatus& status = feedback.status;
  status.fault = overflow_;
  status.fault_text = overflow_ ? "the FIFO of commands is full" : "";
  status.homed = true;
  for (std::size_t i = 0; i < pins_->joints.size(); ++i) {
    const Pins::Joint& joint = pins_->joints[i];
    feedback.position[i] = *joint.feedback;
    feedback.velocity[i] = *joint.velocity;
    if (*joint.fault && !status.fault) {
      status.fault = true;
      status.fault_text = "of the amplifier of ";
      status.fault_text += kJointNames[i];
    }
    status.homed = status.homed && *joint.homed;
  }
}

void HalHardware::readHoming(DriveStatus& status) {
  const bool homing = *pins_->homing;
  if (homing_ && !homing) {
    // Queued commands refer to the old reference: they must leave the FIFO before commands take effect again.
    settling_ = true;
    settled_ = sent_ + 1;
  }
  homing_ = homing;
  if (settling_ && static_cast<std::int32_t>(*pins_->played - settled_) >= 0) settling_ = false;
  status.homing = homing || (settling_ && status.enabled);
}

void HalHardware::write(const DriveCycle&, const DriveCommand& command) {
  if (!command.enable) power_off_ = false;
  writeSwitches(command);
  if (!command.enable || power_off_) {
    switchOff();
  } else if (!*pins_->enable) {
    switchOn(command.position);
  } else if (enabled_) {
    send(command.position);
  }
}

void HalHardware::writeSwitches(const DriveCommand& command) {
  *pins_->heartbeat = !*pins_->heartbeat;
  if (command.reset) {
    reset_cycles_ = kResetCycles;
    overflow_ = false;
  }
  *pins_->fault_reset = reset_cycles_ > 0;
  if (reset_cycles_ > 0) --reset_cycles_;
  *pins_->home = command.home;
  *pins_->spindle_run = command.spindle && !power_off_;
  *pins_->coolant_run = command.coolant && !power_off_;
  for (std::size_t i = 0; i < command.position.size(); ++i) {
    *pins_->joints[i].command = command.position[i];
    *pins_->joints[i].enable = command.enable;
  }
}

bool HalHardware::powerOff() {
  power_off_ = true;
  *pins_->enable = *pins_->spindle_run = *pins_->coolant_run = false;
  return true;
}

void HalHardware::switchOff() {
  *pins_->enable = false;
  if (*pins_->enabled) return;  // the streamer may still be reading
  fifo_->drain();
  sent_ = *pins_->played;
  settling_ = false;
}

void HalHardware::switchOn(const AxisValues& position) {
  if (*pins_->enabled) return;  // HAL has not switched off yet
  // The first commands are queued before power comes on, because the streamer's pins still have the values at which a
  // job was aborted.
  fifo_->drain();
  sent_ = *pins_->played;
  for (std::uint32_t i = 0; i < kept_; ++i) send(position);
  *pins_->enable = !power_off_;
}

void HalHardware::send(const AxisValues& position) {
  if (waiting() < can_.buffer && fifo_->push(position, sent_ + 1)) {
    ++sent_;
  } else {
    overflow_ = true;
  }
}

ros::Duration HalHardware::wait(const ros::Duration& nominal) {
  if (!*pins_->enabled || !*pins_->enable) return Drive::wait(nominal);
  const std::int64_t time = nominal.toNSec() / kNapsPerCycle;
  for (int naps = 0; naps < kNapsPerCycle * kMaxWait; ++naps) {
    if (waiting() < kept_ || !*pins_->enabled) break;
    nap(time);
  }
  return sinceLastCycle(nominal);
}

}  // namespace grinder

FLUTE_GRINDER_EXPORT_DRIVE(grinder::HalHardware)
