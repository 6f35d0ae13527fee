#pragma once

#include <ros/time.h>

namespace grinder {

/// How long ago a peer stamped a message, by the system clock [s]; negative if its clock is ahead. The difference of
/// the stamps themselves throws where it is no ros::Duration.
inline double ageOf(const ros::Time& stamp) { return ros::Time::now().toSec() - stamp.toSec(); }

}  // namespace grinder
