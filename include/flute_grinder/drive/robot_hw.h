#pragma once

#include "flute_grinder/job/fault_text.h"

#include <ros/duration.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <typeindex>
#include <utility>
#include <vector>

/// @file
/// The drive interface, modelled on ros_control's hardware_interface: names, argument order and meaning are the same,
/// so a ros_control driver becomes a driver for the grinder when its base class is changed. There are two additions:
/// DriveHandle, for machine signals that belong to no joint, and RobotHW::wait(), because the drive paces the control
/// loop.
namespace grinder {

/// Thrown if a handle or an interface is missing, or if a handle has a null pointer.
class HardwareInterfaceException : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads the state of a joint from the driver's buffers. Getters are real-time safe.
class JointStateHandle {
 public:
  JointStateHandle() = default;
  /// @param name joint name, as in the URDF.
  /// @param pos position [m or rad].
  /// @param vel velocity [m/s or rad/s].
  /// @param eff effort [N or Nm].
  /// @throw HardwareInterfaceException if a pointer is null.
  JointStateHandle(const std::string& name, const double* pos, const double* vel, const double* eff);

  std::string getName() const { return name_; }
  double getPosition() const { return *pos_; }  ///< [m or rad]
  double getVelocity() const { return *vel_; }  ///< [m/s or rad/s]
  double getEffort() const { return *eff_; }    ///< [N or Nm]

 private:
  std::string name_;
  const double* pos_ = nullptr;
  const double* vel_ = nullptr;
  const double* eff_ = nullptr;
};

/// Reads and commands a joint. Real-time safe except for the constructor.
class JointHandle : public JointStateHandle {
 public:
  JointHandle() = default;
  /// @param js the joint's state.
  /// @param cmd the driver's buffer for the command [m or rad].
  /// @throw HardwareInterfaceException if the pointer is null.
  JointHandle(const JointStateHandle& js, double* cmd);

  void setCommand(double command) { *cmd_ = command; }  ///< [m or rad]
  double getCommand() const { return *cmd_; }           ///< [m or rad]

 private:
  double* cmd_ = nullptr;
};

/// A drive's status, apart from the joint states.
struct DriveStatus {
  bool enabled = false;              ///< power is on, the axes follow their commands
  bool emergency_stop = false;       ///< the emergency stop is pressed
  bool fault = false;                ///< the drive reports a fault of its own
  FaultText fault_text;              ///< which, in the drive's words, with the maker's code; may be empty
  bool homed = false;                ///< positions refer to the machine's reference
  bool homing = false;               ///< the axes are searching for the reference, as commanded
  bool spindle_at_speed = false;     ///< the wheel turns at its grinding speed
  bool coolant_on = false;           ///< coolant flows
  bool probe_free = true;            ///< the measuring probe, if there is one, is out of the wheel's way
  bool has_probe = false;            ///< the drive reads the contact of a measuring probe
  bool probe_contact = false;        ///< the measuring probe touches something
  std::uint64_t feedback_count = 0;  ///< incremented with each fresh set of positions
  /// For a drive that buffers: number of written commands that had not reached the axes when the positions were read.
  std::uint32_t commands_waiting = 0;
  std::uint64_t underruns = 0;  ///< servo cycles since the start in which the powered axes had no command
  /// Angle of the wheel's swivel, positive for right-hand flutes; NaN if the drive does not measure it [rad]
  double swivel = std::numeric_limits<double>::quiet_NaN();
};

/// The maximum number of commands that a drive may buffer; the loop keeps as many, for comparison with the positions.
constexpr std::uint32_t kMaxCommandsWaiting = 4095;

/// Commands to a drive, apart from positions.
struct DriveCommand {
  bool enable = false;   ///< power on; when false, the drive stops the axes at once
  bool reset = false;    ///< clear a fault of the drive; set for one cycle
  bool home = false;     ///< search for the machine's reference while set; position commands are then ignored
  bool spindle = false;  ///< turn the wheel
  bool coolant = false;  ///< coolant on
};

/// Connects the machine signals that belong to no joint. Real-time safe except for the constructor.
class DriveHandle {
 public:
  DriveHandle() = default;
  /// @throw HardwareInterfaceException if a pointer is null.
  DriveHandle(const std::string& name, const DriveStatus* status, DriveCommand* command);

  std::string getName() const { return name_; }
  const DriveStatus& getStatus() const { return *status_; }
  void setCommand(const DriveCommand& command) { *command_ = command; }

 private:
  std::string name_;
  const DriveStatus* status_ = nullptr;
  DriveCommand* command_ = nullptr;
};

/// Handles, accessed by name.
template <typename Handle>
class HardwareResourceManager {
 public:
  /// Adds a handle; replaces one of the same name.
  void registerHandle(const Handle& handle) { handles_[handle.getName()] = handle; }

  /// @throw HardwareInterfaceException if there is no handle of that name.
  Handle getHandle(const std::string& name) const {
    const auto it = handles_.find(name);
    if (it == handles_.end()) throw HardwareInterfaceException("the drive has no handle '" + name + "'");
    return it->second;
  }

  std::vector<std::string> getNames() const {
    std::vector<std::string> names;
    for (const auto& item : handles_) names.push_back(item.first);
    return names;
  }

 private:
  std::map<std::string, Handle> handles_;
};

class JointStateInterface : public HardwareResourceManager<JointStateHandle> {};
class PositionJointInterface : public HardwareResourceManager<JointHandle> {};
class DriveInterface : public HardwareResourceManager<DriveHandle> {};

/// Interfaces, accessed by type.
class InterfaceManager {
 public:
  /// Registers an interface, which must outlive this object.
  template <typename T>
  void registerInterface(T* interface) {
    interfaces_[std::type_index(typeid(T))] = interface;
  }

  /// The interface of that type, or null.
  template <typename T>
  T* get() const {
    const auto it = interfaces_.find(std::type_index(typeid(T)));
    return it == interfaces_.end() ? nullptr : static_cast<T*>(it->second);
  }

 private:
  std::map<std::type_index, void*> interfaces_;
};

/// A drive. A plugin derives from this class, or from AxesHW, which registers a JointStateInterface and a
/// PositionJointInterface with the joints axis_x, axis_y, axis_z and axis_a, and a DriveInterface with the handle
/// "drive".
class RobotHW : public InterfaceManager {
 public:
  virtual ~RobotHW() = default;

  /// Initialises the drive; called once, before all other functions, and not in the control thread.
  /// @param root_nh the node's own namespace.
  /// @param robot_hw_nh the drive's namespace, ~hardware, which contains its parameters.
  /// @return false if the drive cannot be used; log the reason, or throw it.
  virtual bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) = 0;

  /// Reads positions and status. Real-time. What it throws is a fault of the drive, as what write() and wait() throw.
  /// @param time time of the cycle, for stamps.
  /// @param period time since the last cycle, monotonic.
  virtual void read(const ros::Time& time, const ros::Duration& period) = 0;

  /// Sends the commands. Real-time; same arguments as read(). Not called before all positions have been finite once.
  virtual void write(const ros::Time& time, const ros::Duration& period) = 0;

  /// Blocks until the next cycle is due. By default, cycles follow the monotonic clock. Missed cycles are skipped and
  /// never made up, because the axes would then move faster than planned. A drive with its own clock overrides this
  /// function. Real-time.
  /// @param period nominal control period.
  /// @return time since the last cycle, which all time-outs and stamps of the loop follow.
  virtual ros::Duration wait(const ros::Duration& period);

  /// Switches the power off at once, in place of write(), because read(), write() or wait() has not returned for 0.25
  /// s. Called in a thread of its own, maybe while one of these still hangs, or goes on. Enabled must then be reported
  /// as false until `enable` has been. By default nothing is done: the drive's own watchdog is all there is.
  /// @return whether the power is switched off.
  virtual bool powerOff() { return false; }

 protected:
  /// Time since the last call, by the monotonic clock; the nominal period in the first one. Real-time safe.
  ros::Duration sinceLastCycle(const ros::Duration& nominal);

 private:
  std::int64_t next_cycle_ns_ = 0;
  std::int64_t last_cycle_ns_ = 0;  ///< 0 before the first cycle
};

}  // namespace grinder
