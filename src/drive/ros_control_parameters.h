#pragma once

#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/job/axes.h"

#include <array>
#include <string>

namespace grinder {

/// Where a command goes that a RobotHW does not take.
struct CommandSink {
  std::string service;  ///< its name, or
  std::string topic;    ///< the topic's
  explicit operator bool() const { return !service.empty() || !topic.empty(); }
};

/// The parameters of RosControlDrive; see docs/ros-control.md. A signal is "always", "never" or a topic.
struct RosControlParameters {
  std::string robot_hw;  ///< class of the plugin
  std::array<std::string, kAxisCount> joints;
  bool read_is_clock = false;
  double signal_timeout = 0;  ///< 0 for never [s]
  struct {
    std::string emergency_stop, homed, spindle_at_speed, coolant_on;  ///< must be stated
    std::string enabled, fault, probe_free, probe_contact;
  } signals;
  struct {
    CommandSink power;  ///< must be stated, if only that there is none
    CommandSink home, spindle, coolant, reset;
  } commands;
};

/// @throw ParameterError
RosControlParameters readRosControlParameters(const ParameterReader& parameters);

}  // namespace grinder
