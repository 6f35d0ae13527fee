#pragma once

#include "flute_grinder/core/axes.h"
#include "flute_grinder/drive/hal_component.h"
#include "flute_grinder/drive/hal_fifo.h"
#include "flute_grinder/drive/robot_hw.h"

#include <array>
#include <cstdint>
#include <memory>

namespace flute_grinder {

/// Drives that LinuxCNC's HAL speaks to: Mesa cards, step generators, analog and EtherCAT servos. Commands go through
/// the FIFO of a HAL `streamer`, of which each servo cycle plays exactly one; the FIFO's fill paces the control loop,
/// so that the axes do not notice when this program is late by less than the buffer. The HAL file has the emergency
/// stop, the watchdog on the heartbeat and the enable chain; docs/shop-floor-pc.md lists the pins.
///
/// Parameters, in the drive's namespace: `component`, the HAL component's name; `streamer`, the number of the streamer;
/// `buffer` [s], how much motion the FIFO holds.
class HalHardware : public RobotHW {
 public:
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;
  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;
  /// With power, until the FIFO has room for a command; else by the monotonic clock.
  void wait(const ros::Duration& period) override;

 private:
  /// Where HAL has the pins' values; in HAL's memory.
  struct Pins {
    struct Joint {
      hal_float_t *feedback, *velocity, *command;
      hal_bit_t *fault, *homed, *enable;
    };
    std::array<Joint, kAxisCount> joints;
    // Of the machine, from HAL.
    hal_bit_t *enabled, *emergency_stop, *homing, *spindle_at_speed, *coolant_on, *probe_free;
    hal_float_t *servo_cycles, *servo_rate;
    hal_u32_t* played;
    hal_s32_t* underruns;
    // To HAL.
    hal_bit_t *enable, *heartbeat, *fault_reset, *home, *spindle_run, *coolant_run;
  };

  void makePins();
  void checkServoThread(double control_rate) const;
  void registerHandles();
  void readJoints();
  void readHoming();
  void writeSwitches();
  void switchOn();
  void switchOff();
  void send();
  std::uint32_t waiting() const { return sent_ - *pins_->played; }

  std::unique_ptr<HalComponent> component_;
  std::unique_ptr<HalFifo> fifo_;
  Pins* pins_ = nullptr;
  std::uint32_t buffer_ = 0;  ///< commands that the FIFO is filled with

  std::uint32_t sent_ = 0;  ///< the last command's number
  bool overflow_ = false;   ///< a command found no room
  double servo_cycles_ = 0;
  int reset_cycles_ = 0;       ///< left of the pulse
  bool homing_ = false;        ///< HAL was homing in the cycle before
  std::uint32_t settled_ = 0;  ///< the first command after homing that has the new reference
  bool settling_ = false;      ///< commands of the old reference may still wait

  std::array<double, kAxisCount> position_{}, velocity_{}, effort_{}, command_{};
  DriveStatus status_;
  DriveCommand drive_command_;
  JointStateInterface joint_states_;
  PositionJointInterface joint_commands_;
  DriveInterface drive_;
};

}  // namespace flute_grinder
