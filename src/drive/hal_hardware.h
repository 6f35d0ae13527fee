#pragma once

#include "drive/hal_component.h"
#include "drive/hal_fifo.h"
#include "flute_grinder/drive/drive.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

namespace grinder {

/// Hardware behind LinuxCNC's HAL: Mesa cards, step generators, analog and EtherCAT servos. Commands go through the
/// FIFO of a HAL `streamer`; each servo cycle plays exactly one. The fill level of the FIFO paces the control loop, so
/// the axes keep moving if this program is late by less than the buffer. The HAL file contains the emergency stop, the
/// watchdog on the heartbeat and the enable chain; docs/shop-floor-pc.md lists the pins.
///
/// Parameters, in the drive's namespace: `component`, name of the HAL component; `streamer`, number of the streamer;
/// `buffer` [s], duration of the motion that the FIFO holds.
class HalHardware : public Drive {
 public:
  void init(ros::NodeHandle& node_nh, ros::NodeHandle& drive_nh) override;
  DriveCapabilities capabilities() const override { return can_; }
  void read(const DriveCycle& cycle, DriveFeedback& feedback) override;
  void write(const DriveCycle& cycle, const DriveCommand& command) override;
  bool powerOff() override;
  /// With power on, waits until the FIFO has room for a command; otherwise uses the monotonic clock.
  ros::Duration wait(const ros::Duration& nominal) override;

 private:
  /// Pointers to the pins' values, in HAL's memory.
  struct Pins {
    struct Joint {
      hal_float_t *feedback, *velocity, *command;
      hal_bit_t *fault, *homed, *enable;
    };
    std::array<Joint, kAxisCount> joints;
    // Inputs from HAL, about the machine.
    hal_bit_t *enabled, *emergency_stop, *homing, *spindle_at_speed, *coolant_on, *probe_free, *probe_contact;
    hal_float_t *servo_cycles, *servo_rate, *swivel;
    hal_u32_t* played;
    hal_s32_t* underruns;
    // Outputs to HAL.
    hal_bit_t *enable, *heartbeat, *fault_reset, *home, *spindle_run, *coolant_run;
  };

  void makePins();
  void checkServoThread(double control_rate) const;
  void readJoints(DriveFeedback& feedback) const;
  void readHoming(DriveStatus& status);
  void writeSwitches(const DriveCommand& command);
  void switchOn(const AxisValues& position);
  void switchOff();
  void send(const AxisValues& position);
  std::uint32_t waiting() const { return sent_ - *pins_->played; }

  std::unique_ptr<HalComponent> component_;
  std::unique_ptr<HalFifo> fifo_;
  Pins* pins_ = nullptr;
  DriveCapabilities can_;   ///< capabilities for which HAL has the signals
  std::uint32_t kept_ = 0;  ///< commands to keep in the FIFO

  std::atomic<bool> power_off_{false};  ///< powerOff() was called, and `enable` has not been false since

  bool enabled_ = false;    ///< HAL reported power at the last read()
  std::uint32_t sent_ = 0;  ///< number of the last command
  bool overflow_ = false;   ///< the FIFO was full when a command was to be written
  double servo_cycles_ = 0;
  int reset_cycles_ = 0;       ///< remaining cycles of the reset pulse
  bool homing_ = false;        ///< HAL was homing in the previous cycle
  std::uint32_t settled_ = 0;  ///< number of the first command relative to the new reference
  bool settling_ = false;      ///< commands relative to the old reference may still be queued
};

}  // namespace grinder
