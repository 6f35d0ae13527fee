/// @file
/// Makes the programs that link this file ignore the clock of a simulation. With /use_sim_time, roscpp takes its time
/// from /clock, and its timers, actionlib and diagnostic_updater throw if that time plus a period exceeds the range of
/// ros::Time. A machine runs by the system clock.

#include <ros/time.h>

namespace ros {

/// Called with each message on /clock; ignores it.
void Time::setNow(const Time&) {}

}  // namespace ros
