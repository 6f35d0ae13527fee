#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/fault_text.h"

#include <ros/duration.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <array>
#include <cstdint>
#include <limits>

/// @file
/// The drive interface: what a plugin implements to connect the grinder to its hardware. In a cycle the loop reads the
/// feedback, computes, and writes the command; the drive paces the loop.
namespace grinder {

/// One value per axis, in the order of kJointNames.
using AxisValues = std::array<double, kAxisCount>;

/// A drive's status, apart from its positions.
struct DriveStatus {
  bool enabled = false;              ///< power is on, the axes follow their commands
  bool emergency_stop = false;       ///< the emergency stop is pressed
  bool fault = false;                ///< the drive reports a fault of its own
  FaultText fault_text;              ///< the fault in the drive's words, with the maker's code; may be empty
  bool homed = false;                ///< positions refer to the machine's reference
  bool homing = false;               ///< the axes are searching for the reference, as commanded
  bool spindle_at_speed = false;     ///< the wheel turns at its grinding speed
  bool coolant_on = false;           ///< coolant flows
  bool probe_free = true;            ///< the measuring probe, if there is one, is out of the wheel's way
  bool probe_contact = false;        ///< the measuring probe touches something
  std::uint64_t feedback_count = 0;  ///< incremented with each fresh set of positions
  /// For a drive that buffers: number of written commands that had not reached the axes when the positions were read.
  /// More than DriveCapabilities::buffer is a fault of the drive.
  std::uint32_t commands_waiting = 0;
  std::uint64_t underruns = 0;  ///< servo cycles since the start in which the powered axes had no command
  /// Angle of the wheel's swivel, positive for right-hand flutes; NaN if the drive does not measure it [rad]
  double swivel = std::numeric_limits<double>::quiet_NaN();
};

/// The maximum number of commands that a drive may buffer; the loop keeps as many, for comparison with the positions.
constexpr std::uint32_t kMaxCommandsWaiting = 4095;

/// What a drive can do. The loop asks for nothing else.
struct DriveCapabilities {
  bool homing = false;    ///< the drive searches for the machine's reference when commanded
  bool spindle = false;   ///< the drive turns the wheel when commanded
  bool coolant = false;   ///< the drive switches the coolant when commanded
  bool probe = false;     ///< the drive reads the contact of a measuring probe
  bool swivel = false;    ///< the drive measures the angle of the wheel's swivel
  bool prepares = false;  ///< prepare() is to be called before the power is switched on
  /// The maximum number of commands that the drive buffers, up to kMaxCommandsWaiting.
  std::uint32_t buffer = 0;
  double shortest_period = 0;  ///< shortest control period that the drive can keep; 0 for any [s]
};

/// The readings of a drive.
struct DriveFeedback {
  AxisValues position{};  ///< positions of the axes [m], A [rad]
  AxisValues velocity{};  ///< velocities of the axes [m/s], A [rad/s]
  DriveStatus status;
};

/// A command to the drive.
struct DriveCommand {
  bool enable = false;    ///< power on; when false, the drive stops the axes at once
  bool reset = false;     ///< clear a fault of the drive; set for one cycle
  bool home = false;      ///< search for the machine's reference while set; positions are then ignored
  bool spindle = false;   ///< turn the wheel
  bool coolant = false;   ///< coolant on
  AxisValues position{};  ///< commanded positions of the axes [m], A [rad]
};

/// The times of a cycle.
struct DriveCycle {
  ros::Time time;         ///< time of the cycle, for stamps
  ros::Duration period;   ///< measured time since the last cycle, monotonic
  ros::Duration nominal;  ///< control period for which setpoints are computed
};

/// A drive. A plugin derives from it.
class Drive {
 public:
  Drive() = default;
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;
  virtual ~Drive() = default;

  /// Connects to the hardware; called once, before all other functions, and not in the control thread.
  /// @param node_nh the node's namespace, with the parameters of the machine.
  /// @param drive_nh the drive's namespace, ~hardware, with its own parameters.
  /// @throw std::exception with the reason why the drive cannot be used.
  virtual void init(ros::NodeHandle& node_nh, ros::NodeHandle& drive_nh) = 0;

  /// What the drive can do with its hardware and parameters. Called after init(); constant from then on.
  virtual DriveCapabilities capabilities() const = 0;

  /// Makes the hardware ready for power. Called in a thread of its own after every request to enable, before
  /// DriveCommand::enable is set, while read() and write() go on; may block. If it takes longer than the machine's
  /// enable_timeout, the request fails, and further ones are refused until it returns.
  /// @throw std::exception with the reason why the power must stay off.
  virtual void prepare() {}

  /// Reads the hardware. Real-time. An exception from read(), write() or wait() is a drive fault.
  /// @param feedback readings to update, as left by the last call; at first the defaults.
  virtual void read(const DriveCycle& cycle, DriveFeedback& feedback) = 0;

  /// Sends the command. Real-time. The first call comes after all positions have been finite at least once.
  virtual void write(const DriveCycle& cycle, const DriveCommand& command) = 0;

  /// Blocks until the next cycle is due. By default, cycles follow the monotonic clock. Missed cycles are skipped and
  /// never made up, because the axes would then move faster than planned. A drive with its own clock overrides this
  /// function. Real-time.
  /// @param nominal control period.
  /// @return time since the last cycle, which all timeouts and stamps of the loop follow.
  virtual ros::Duration wait(const ros::Duration& nominal);

  /// Switches the power off at once, in place of write(), because read(), write() or wait() has not returned for 0.25
  /// s. Called in a thread of its own, possibly while one of them still hangs or continues. DriveStatus::enabled must
  /// then stay false until DriveCommand::enable has been false; the loop sets `enable` again only after this function
  /// has returned. The default does nothing and leaves it to the drive's own watchdog.
  /// @return whether the power is switched off.
  virtual bool powerOff() { return false; }

 protected:
  /// Time since the last call, by the monotonic clock; the nominal period in the first call. Real-time safe.
  ros::Duration sinceLastCycle(const ros::Duration& nominal);

 private:
  std::int64_t next_cycle_ns_ = 0;
  std::int64_t last_cycle_ns_ = 0;  ///< time of the last cycle; 0 before the first cycle
};

}  // namespace grinder
