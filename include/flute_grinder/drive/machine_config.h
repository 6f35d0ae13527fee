#pragma once

#include "flute_grinder/drive/control_loop.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <stdexcept>
#include <string>

namespace flute_grinder {

/// A machine's description that cannot be used; what() names the parameter and what is allowed.
class MachineConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads parameters of one namespace, and refuses what is missing, of the wrong type or out of range.
class ParameterReader {
 public:
  /// @param parameters all of the namespace, as a struct.
  /// @param ns the namespace, for messages, e.g. "/grinder".
  ParameterReader(const XmlRpc::XmlRpcValue& parameters, std::string ns);

  bool has(const std::string& path) const;
  /// @throw MachineConfigError unless the parameter is a finite number from `min` to `max`.
  double number(const std::string& path, double min, double max) const;
  /// @throw MachineConfigError unless the parameter is a bool.
  bool flag(const std::string& path) const;
  /// @throw MachineConfigError unless the parameter is a string that is not empty.
  std::string text(const std::string& path) const;
  /// The parameter's full name.
  std::string name(const std::string& path) const { return ns_ + "/" + path; }

 private:
  XmlRpc::XmlRpcValue find(const std::string& path) const;
  XmlRpc::XmlRpcValue require(const std::string& path, const char* what) const;

  XmlRpc::XmlRpcValue parameters_;
  std::string ns_;
};

/// The machine: limits from the URDF, and over them the parameters joint_limits/<joint>/..., as in ros_control;
/// control_rate, park_position/<joint>, constraints/<joint>/trajectory, feedback_timeout, enable_timeout,
/// homing_timeout, spindle_timeout, max_job_duration, late_cycle/slow_down and .../fault. Fails closed: every axis
/// needs limits of position, velocity, acceleration and jerk, and each is stated in full.
/// @param urdf the robot description, XML.
/// @param parameters the node's parameters.
/// @throw MachineConfigError
LoopConfig readMachineConfig(const std::string& urdf, const ParameterReader& parameters);

}  // namespace flute_grinder
