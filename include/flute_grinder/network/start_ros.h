#pragma once

#include <ros/service_server.h>

namespace grinder {

/// Starts roscpp after initRos(), for a node that serves others for long. Other than by ros::start() alone,
/// - up to some 4000 connections of careless clients leave descriptors for the node's own files;
/// - a datagram to the UDP port, which roscpp polls but never reads, does not keep its network thread busy for ever;
/// - clients connect soon, see connectPromptly();
/// - `~get_loggers` can be called again and again. rosconsole's own answer, with the log4cxx of Debian 12, frees the
///   loggers that it lists, and the second call ends the process.
/// @return the service `~get_loggers`, which lasts as long as this object. ROS's global callback queue serves it.
ros::ServiceServer startRos();

}  // namespace grinder
