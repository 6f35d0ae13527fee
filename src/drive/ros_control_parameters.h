#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/drive/parameters.h"

#include <array>
#include <string>

namespace grinder {

/// The destination of a command that a RobotHW does not take: a service or a topic.
struct CommandSink {
  std::string service;  ///< name of the service, or empty
  std::string topic;    ///< name of the topic, or empty
  explicit operator bool() const { return !service.empty() || !topic.empty(); }
};

/// The parameters of RosControlDrive; see docs/ros-control.md. A signal is "always", "never" or a topic.
struct RosControlParameters {
  std::string robot_hw;  ///< class of the plugin
  std::array<std::string, kAxisCount> joints;
  bool read_is_clock = false;
  double signal_timeout = 0;  ///< time after which a received signal expires; 0 for never [s]
  struct {
    std::string emergency_stop, homed, spindle_at_speed, coolant_on;  ///< required
    std::string enabled, fault, probe_free, probe_contact;
  } signals;
  struct {
    CommandSink power;  ///< required, even if only to say that there is none
    CommandSink home, spindle, coolant, reset;
  } commands;
};

/// @throw ParameterError
RosControlParameters readRosControlParameters(const ParameterReader& parameters);

}  // namespace grinder
